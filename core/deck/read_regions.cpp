// Sources that fill a region: lattice and packing.
#include <barchan/core/deck/read_regions.hpp>

#include <fmt/format.h>

#include <barchan/core/deck/boxes.hpp>
#include <barchan/core/deck/read_sizes.hpp>

namespace barchan::deck {

namespace {

constexpr double kMaxParticles = 2e9;
constexpr std::size_t kMaxHoles = 1000;
constexpr double kSlack = 1e-9;

Box read_region(const TableReader& table, const Model& model) {
  const Node& node = *table.table("region");
  Box region = read_box(node, table.dimension(), "the region");
  check_inside(region, model, node.place(), "the region");
  return region;
}

void check_room(const TableReader& table, const Box& region, double needed) {
  for (int axis = 0; axis < table.dimension(); ++axis) {
    const double extent = region.hi[axis] - region.lo[axis];
    if (extent < needed * (1.0 - kSlack)) {
      table.fail("region",
                 fmt::format("the region is {} m thin, too thin for one particle that takes {} m",
                             extent, needed),
                 "widen the region or use smaller radii");
    }
  }
}

void check_count(const TableReader& table, std::string_view key, double count) {
  if (!(count <= kMaxParticles)) {
    table.fail(key, fmt::format("this asks for {:.3g} particles", count),
               "at most 2e9; use larger radii");
  }
}

LatticeSource::Arrangement read_arrangement(const TableReader& table) {
  using Arrangement = LatticeSource::Arrangement;
  const bool is_2d = table.dimension() == 2;
  if (!table.has("arrangement")) return is_2d ? Arrangement::Square : Arrangement::Cubic;
  const std::string name = table.string("arrangement");
  if (is_2d != (name == "square" || name == "hexagonal")) {
    table.fail("arrangement",
               fmt::format("arrangement = \"{}\" in {} dimensions", name, table.dimension()),
               is_2d ? "in 2D write square or hexagonal" : "in 3D write cubic or fcc");
  }
  if (is_2d) return name == "square" ? Arrangement::Square : Arrangement::Hexagonal;
  return name == "cubic" ? Arrangement::Cubic : Arrangement::Fcc;
}

std::vector<Hole> read_holes(const TableReader& table) {
  const auto nodes = table.tables("holes");
  if (nodes.size() > kMaxHoles) {
    table.fail("holes", fmt::format("{} holes in one packing", nodes.size()), "at most 1000");
  }
  std::vector<Hole> holes;
  for (const Node* node : nodes) {
    const TableReader hole(*node, table.dimension(), "hole");
    holes.push_back({hole.vector("center"), hole.number("radius")});
  }
  return holes;
}

/// `count` or `solid_fraction`, one of them.
void read_amount(const TableReader& table, PackingSource& packing) {
  if (!table.has_one_of("count", "solid_fraction")) {
    table.fail("", "this packing does not say how many particles it has",
               "add count or solid_fraction");
  }
  packing.count = table.optional_integer("count");
  packing.solid_fraction = table.optional_number("solid_fraction");
  const double space = measure(packing.region, table.dimension());
  const double each = mean_measure(packing.sizes, table.dimension());
  const double wanted =
      packing.count ? static_cast<double>(*packing.count) : *packing.solid_fraction * space / each;
  check_count(table, packing.count ? "count" : "solid_fraction", wanted);
  if (packing.count && wanted * each > space) {
    table.fail(
        "count",
        fmt::format("{} particles fill {:.3g} times the region", *packing.count,
                    wanted * each / space),
        fmt::format("random packings fill about {} of it", table.dimension() == 2 ? 0.8 : 0.6));
  }
}

}  // namespace

LatticeSource read_lattice(const TableReader& table, const Model& model) {
  LatticeSource lattice;
  lattice.arrangement = read_arrangement(table);
  lattice.region = read_region(table, model);
  lattice.sizes = read_sizes(table);
  const double diameter = 2.0 * lattice.sizes.max_radius();
  lattice.spacing = table.optional_number("spacing").value_or(diameter);
  if (lattice.spacing < diameter * (1.0 - kSlack)) {
    table.fail("spacing",
               fmt::format("particles of diameter {} overlap at a spacing of {}", diameter,
                           lattice.spacing),
               fmt::format("write at least {}", diameter));
  }
  lattice.jitter = table.number("jitter");
  lattice.seed = static_cast<std::uint64_t>(table.integer("seed"));
  check_room(table, lattice.region, lattice.spacing);
  double count = 1.0;
  for (int axis = 0; axis < table.dimension(); ++axis) {
    count *= (lattice.region.hi[axis] - lattice.region.lo[axis]) / lattice.spacing;
  }
  check_count(table, "region", count);
  return lattice;
}

PackingSource read_packing(const TableReader& table, const Model& model) {
  PackingSource packing;
  packing.region = read_region(table, model);
  packing.sizes = read_sizes(table);
  packing.holes = read_holes(table);
  packing.seed = static_cast<std::uint64_t>(table.integer("seed"));
  check_room(table, packing.region, 2.0 * packing.sizes.max_radius());
  read_amount(table, packing);
  return packing;
}

}  // namespace barchan::deck
