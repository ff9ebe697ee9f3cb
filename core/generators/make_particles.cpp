#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <unordered_set>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/generators/file_particles.hpp>
#include <barchan/core/generators/lattice.hpp>
#include <barchan/core/generators/link_bonds.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/generators/packing.hpp>

namespace barchan {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kStays = "leave velocity and omega out, or fix the box of those that stay";

std::vector<Grain> make_ring(const RingSource& ring) {
  std::vector<Grain> grains;
  for (std::int64_t k = 0; k < ring.count; ++k) {
    const double angle = ring.start_angle + 2.0 * std::numbers::pi * static_cast<double>(k) /
                                                static_cast<double>(ring.count);
    grains.push_back({ring.center + ring.radius * Vec3(std::cos(angle), std::sin(angle), 0.0),
                      ring.disk_radius});
  }
  return grains;
}

bool box_contains(const Box& box, const Vec3& position, int dimension) {
  for (int axis = 0; axis < dimension; ++axis) {
    if (position[axis] < box.lo[axis] || position[axis] > box.hi[axis]) return false;
  }
  return true;
}

/// Brings a centre that lies within one length of a periodic axis into [lo, hi).
void wrap(Vec3& position, const Domain& domain, int dimension) {
  for (int axis = 0; axis < dimension; ++axis) {
    if (!domain.periodic[static_cast<std::size_t>(axis)]) continue;
    double& x = position[axis];
    const double lo = domain.lo[axis];
    const double hi = domain.hi[axis];
    if (x < lo && x >= lo - (hi - lo)) x += hi - lo;
    if (x >= hi && x < hi + (hi - lo)) x = std::max(lo, x - (hi - lo));
  }
}

bool moves(const ParticleData& particle) {
  return !particle.velocity.isZero(0.0) || !particle.omega.isZero(0.0);
}

/// Of a particle of a source. A file is read once more: an error ends all anyway.
SourcePlace place_in(const ParticleSource& source, std::size_t index) {
  if (const auto* list = std::get_if<ListSource>(&source.kind))
    return index < list->places.size() ? list->places[index] : source.place;
  const auto* file = std::get_if<FileSource>(&source.kind);
  if (file == nullptr) return source.place;
  const ParticleFile rows = read_particles(file->path);
  return {rows.file, index < rows.lines.size() ? rows.lines[index] : 0, 0};
}

/// Appends source after source; holds the set under construction.
class Maker {
 public:
  explicit Maker(const Model& model) : model_(model) {}

  void add(const ParticleSource& source) {
    const std::size_t first = set_.particles.size();
    has_own_bonds_ = false;
    std::visit([&](const auto& kind) { add_kind(source, kind); }, source.kind);
    for (std::size_t i = first; i < set_.particles.size(); ++i)
      finish_particle(set_.particles[i], source, i - first);
    if (source.bond && !has_own_bonds_) link_bonds(model_, source, first, set_);
  }

  [[nodiscard]] std::size_t size() const { return set_.particles.size(); }
  [[nodiscard]] ParticleSet take() { return std::move(set_); }

 private:
  void add_kind(const ParticleSource& source, const LatticeSource& kind) {
    add_grains(source, make_lattice(kind, model_.dimension, source.place));
  }
  void add_kind(const ParticleSource& source, const PackingSource& kind) {
    add_grains(source, make_packing(model_, kind, source.place));
  }
  void add_kind(const ParticleSource& source, const RingSource& kind) {
    add_grains(source, make_ring(kind));
  }

  void add_kind(const ParticleSource&, const ListSource& kind) {
    for (ParticleData particle : kind.particles) {
      particle.id = ++last_id_;
      set_.particles.push_back(particle);
    }
  }

  void add_kind(const ParticleSource& source, const FileSource& kind) {
    const ParticleFile file = read_source(model_, source, kind);
    const std::vector<std::string> notes = notes_on(model_, file);
    set_.notes.insert(set_.notes.end(), notes.begin(), notes.end());
    set_.bonds.insert(set_.bonds.end(), file.bonds.begin(), file.bonds.end());
    has_own_bonds_ = file.has_bonds && source.links.pairs.empty();
    check_ids(file);
    for (std::size_t i = 0; i < file.particles.size(); ++i) add_row(source, file, i);
    for (const ParticleData& particle : file.particles) last_id_ = std::max(last_id_, particle.id);
  }

  void check_ids(const ParticleFile& file) const {
    constexpr std::int64_t kHighest = std::int64_t{1} << 62;
    std::unordered_set<std::int64_t> taken;
    for (const ParticleData& particle : set_.particles) taken.insert(particle.id);
    for (std::size_t i = 0; i < file.particles.size(); ++i) {
      const std::int64_t id = file.particles[i].id;
      if (id >= kHighest)
        throw InputError(SourcePlace{file.file, file.lines[i], 0},
                         fmt::format("particle id {} is too large", id),
                         fmt::format("ids go up to {}", kHighest - 1));
      if (!taken.contains(id)) continue;
      throw InputError(
          SourcePlace{file.file, file.lines[i], 0},
          fmt::format("particle id {} is already taken", id),
          fmt::format("ids of this file must differ from those before it, that is be above {}",
                      last_id_));
    }
  }

  void add_row(const ParticleSource& source, const ParticleFile& file, std::size_t row) {
    ParticleData particle = file.particles[row];
    const auto refuse = [&](const std::string& what, const std::string& remedy) {
      throw InputError(SourcePlace{file.file, file.lines[row], 0},
                       fmt::format("particle {} {}", particle.id, what), remedy);
    };
    if (source.material) particle.type = *source.material;
    if (source.density) particle.density = *source.density;
    if (particle.type >= static_cast<std::int32_t>(model_.materials.size())) {
      refuse(fmt::format("is of type {}", particle.type + 1),
             fmt::format("the deck has {} materials", model_.materials.size()));
    }
    const bool is_flat = particle.position.z() == 0.0 && particle.velocity.z() == 0.0 &&
                         particle.omega.x() == 0.0 && particle.omega.y() == 0.0;
    if (model_.dimension == 2 && !is_flat)
      refuse("leaves the plane", "in 2D z, vz, omegax and omegay are zero");
    wrap(particle.position, model_.domain, model_.dimension);
    if (!is_inside(model_.domain, particle.position, model_.dimension)) {
      refuse(fmt::format("at {} is outside the domain",
                         in_brackets(particle.position, model_.dimension)),
             "enlarge the domain or leave the particle out");
    }
    particle.velocity += source.velocity;
    particle.omega += source.omega;
    if (is_contradictory(particle, source)) refuse("is fixed and has a velocity", kStays);
    set_.particles.push_back(particle);
  }

  void add_grains(const ParticleSource& source, const std::vector<Grain>& grains) {
    const int material = source.material.value_or(0);
    const double density =
        source.density.value_or(model_.materials.at(static_cast<std::size_t>(material)).density);
    for (const Grain& grain : grains) {
      ParticleData particle;
      particle.id = ++last_id_;
      particle.type = material;
      particle.radius = grain.radius;
      particle.density = density;
      particle.position = grain.position;
      particle.velocity = source.velocity;
      particle.omega = source.omega;
      set_.particles.push_back(particle);
    }
  }

  [[nodiscard]] bool is_fixed(const ParticleData& particle, const ParticleSource& source) const {
    return source.fixed && box_contains(*source.fixed, particle.position, model_.dimension);
  }

  /// Who fixes all of a source, or lists a particle in the fixed box, cannot mean a velocity. In
  /// the box of any other source it is for those outside, or of a state that is to be frozen.
  [[nodiscard]] bool is_contradictory(const ParticleData& particle,
                                      const ParticleSource& source) const {
    if (!is_fixed(particle, source) || !moves(particle)) return false;
    return std::isinf(source.fixed->lo.x()) || std::holds_alternative<ListSource>(source.kind);
  }

  /// @param index  within the source
  void finish_particle(ParticleData& particle, const ParticleSource& source,
                       std::size_t index) const {
    wrap(particle.position, model_.domain, model_.dimension);
    particle.fixed = is_fixed(particle, source);
    if (!model_.heat.is_on)
      particle.temperature = kNone;
    else if (source.temperature && !std::holds_alternative<ListSource>(source.kind))
      particle.temperature = *source.temperature;
    else if (std::isnan(particle.temperature))
      particle.temperature = model_.heat.temperature;
    if (is_contradictory(particle, source)) {
      throw InputError(place_in(source, index),
                       fmt::format("particle {} is fixed and has a velocity", particle.id), kStays);
    }
    if (particle.fixed) particle.velocity = particle.omega = Vec3::Zero();
    if (is_inside(model_.domain, particle.position, model_.dimension)) return;
    throw InputError(place_in(source, index),
                     fmt::format("particle {} at {} is outside the domain", particle.id,
                                 in_brackets(particle.position, model_.dimension)),
                     "keep the source within the domain");
  }

  const Model& model_;
  ParticleSet set_;
  std::int64_t last_id_ = 0;
  bool has_own_bonds_ = false;  ///< the source at hand, which needs no others
};

}  // namespace

bool is_inside(const Domain& domain, const Vec3& position, int dimension) {
  return box_contains({domain.lo, domain.hi}, position, dimension);
}

ParticleSet make_particles(const Model& model, std::span<const ParticleSource> sources) {
  std::vector<std::size_t> begins;
  return make_particles(model, sources, begins);
}

ParticleSet make_particles(const Model& model, std::span<const ParticleSource> sources,
                           std::vector<std::size_t>& begins) {
  Maker maker(model);
  begins.clear();
  for (const ParticleSource& source : sources) {
    begins.push_back(maker.size());
    maker.add(source);
  }
  begins.push_back(maker.size());
  return maker.take();
}

SourcePlace place_of_particle(std::span<const ParticleSource> sources,
                              std::span<const std::size_t> begins, std::size_t index) {
  const auto next = std::upper_bound(begins.begin(), begins.end(), index);
  const auto s = static_cast<std::size_t>(next - begins.begin()) - 1;
  return place_in(sources[s], index - begins[s]);
}

}  // namespace barchan
