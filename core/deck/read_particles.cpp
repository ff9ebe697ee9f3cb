// [[particles]]: what all sources share, and the sources without a region.
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <barchan/core/deck/boxes.hpp>
#include <barchan/core/deck/canonical.hpp>
#include <barchan/core/deck/read_links.hpp>
#include <barchan/core/deck/read_regions.hpp>
#include <barchan/core/deck/readers.hpp>
#include <barchan/core/deck/values.hpp>
#include <barchan/core/io/particle_file.hpp>

namespace barchan::deck {

namespace {

constexpr std::size_t kMaxSources = 1000;
constexpr std::size_t kMaxListed = 100'000;
constexpr std::int64_t kMaxRing = 1'000'000;

FileSource read_file_source(const TableReader& table, const DeckDraft& draft) {
  const std::string text = table.string("path");
  const std::filesystem::path path(text);
  const auto format = particle_format(text);
  if (!format)
    table.fail("path", fmt::format("'{}' does not say what kind of file it is", text),
               std::string("name a file that ends in ") + kParticleEndings);
  FileSource source;
  source.path = path.is_absolute() ? text : (std::filesystem::path(draft.folder) / path).string();
  source.has_sphere_density = table.string("data_density") == "sphere";
  if (table.has("data_density") && (table.dimension() != 2 || format != ParticleFormat::LammpsData))
    table.fail("data_density", "data_density where densities have one meaning",
               "it is for LAMMPS data in 2D");
  return source;
}

RingSource read_ring(const TableReader& table, const DeckDraft& draft) {
  if (table.dimension() != 2) table.fail("kind", "a ring of disks in 3D", "rings exist in 2D only");
  RingSource ring;
  ring.center = table.vector("center");
  ring.radius = table.number("radius");
  ring.count = *table.optional_integer("count");
  ring.start_angle = table.number("start_angle");
  if (ring.count < 3 || ring.count > kMaxRing) {
    table.fail("count", fmt::format("a ring of {} disks", ring.count), "write 3 to 1000000 disks");
  }
  const double touching =
      ring.radius * std::sin(std::numbers::pi / static_cast<double>(ring.count));
  ring.disk_radius = table.optional_number("disk_radius").value_or(touching);
  if (ring.disk_radius > touching * (1.0 + 1e-9)) {
    table.fail("disk_radius",
               fmt::format("disks of radius {} overlap along the ring", ring.disk_radius),
               fmt::format("neighbours touch at {} m", touching));
  }
  const Vec3 reach(ring.radius + ring.disk_radius, ring.radius + ring.disk_radius, 0.0);
  check_inside({ring.center - reach, ring.center + reach}, draft.deck.model, table.place("center"),
               "the ring");
  return ring;
}

/// What one particle of a list is when it says nothing itself.
ParticleData defaults_of(const ParticleSource& source) {
  ParticleData particle;
  particle.type = source.material.value_or(-1);
  particle.density = source.density.value_or(0.0);
  particle.velocity = source.velocity;
  particle.omega = source.omega;
  if (source.temperature) particle.temperature = *source.temperature;
  return particle;
}

ParticleData read_particle(const TableReader& table, const ParticleData& defaults,
                           const DeckDraft& draft) {
  const Model& model = draft.deck.model;
  ParticleData particle = defaults;
  particle.position = table.vector("position");
  particle.radius = table.number("radius");
  if (table.has("velocity")) particle.velocity = table.vector("velocity");
  if (table.has("omega")) particle.omega = table.spin("omega");
  particle.temperature = heat_number(table, "temperature", model).value_or(particle.temperature);
  if (const auto material = table.optional_string("material")) {
    particle.type = draft.materials.at(*material, table.place("material"));
  }
  if (particle.type < 0) {
    throw InputError(table.place(), "this particle has no material",
                     "add material = \"...\" to it or to the [[particles]] table");
  }
  if (particle.density == 0.0) particle.density = model.materials[particle.type].density;
  particle.density = table.optional_number("density").value_or(particle.density);
  check_inside({particle.position, particle.position}, model, table.place("position"),
               "the particle");
  return particle;
}

ListSource read_list(const TableReader& table, const ParticleSource& source,
                     const DeckDraft& draft) {
  ListSource list;
  const ParticleData defaults = defaults_of(source);
  const auto nodes = table.tables("particle");
  if (nodes.empty() || nodes.size() > kMaxListed) {
    table.fail("particle", fmt::format("a list of {} particles", nodes.size()),
               "write 1 to 100000; more of them belong into a file");
  }
  for (const Node* node : nodes) {
    list.particles.push_back(
        read_particle(TableReader(*node, table.dimension(), "particle"), defaults, draft));
    list.places.push_back(node->place());
  }
  return list;
}

std::optional<Box> read_fixed(const TableReader& table) {
  const Node* node = table.value("fixed");
  if (!node) return std::nullopt;
  if (node->kind == Node::Kind::Table) return read_box(*node, table.dimension(), "the fixed box");
  if (!table.boolean("fixed")) return std::nullopt;
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  return Box{Vec3::Constant(-kEndless), Vec3::Constant(kEndless)};
}

ParticleSource read_common(const TableReader& table, const DeckDraft& draft,
                           const std::string& kind) {
  ParticleSource source;
  source.place = table.place();
  if (const auto material = table.optional_string("material")) {
    source.material = draft.materials.at(*material, table.place("material"));
  } else if (kind != "file" && kind != "list") {
    throw InputError(table.place(), "[[particles]] lacks the key 'material'",
                     "add material = \"<name of a material>\"");
  }
  source.density = table.optional_number("density");
  source.velocity = table.vector("velocity");
  source.omega = table.spin("omega");
  source.temperature = heat_number(table, "temperature", draft.deck.model);
  if (const auto bond = table.optional_string("bond"))
    source.bond = draft.bonds.at(*bond, table.place("bond"));
  source.links = read_links(table);
  source.fixed = read_fixed(table);
  return source;
}

std::string read_kind(const Node& node) {
  const Node::Member* kind = node.kind == Node::Kind::Table ? node.find("kind") : nullptr;
  const KeySpec& spec = *find_key("[[particles]]", "kind");
  if (!kind) {
    throw InputError(node.place(), "[[particles]] lacks the key 'kind'",
                     fmt::format("add kind = one of {}", type_text(spec)));
  }
  return checked_string(kind->value, spec);
}

}  // namespace

void read_particles(const TableReader& root, DeckDraft& draft) {
  const auto nodes = root.tables("particles");
  if (nodes.empty() || nodes.size() > kMaxSources) {
    root.fail("particles", fmt::format("{} tables of [[particles]]", nodes.size()),
              "write 1 to 1000 of them");
  }
  for (const Node* node : nodes) {
    const std::string kind = read_kind(*node);
    const TableReader table(*node, root.dimension(), "[[particles]]", kind);
    ParticleSource source = read_common(table, draft, kind);
    source.record = {kind, source.place.line, canonical_keys(*node), 0};
    if (kind == "file") source.kind = read_file_source(table, draft);
    if (kind == "lattice") source.kind = read_lattice(table, draft.deck.model);
    if (kind == "packing") source.kind = read_packing(table, draft.deck.model);
    if (kind == "ring") source.kind = read_ring(table, draft);
    if (kind == "list") source.kind = read_list(table, source, draft);
    draft.deck.sources.push_back(std::move(source));
  }
}

}  // namespace barchan::deck
