#include <barchan/tasks/memory_estimate.hpp>

#include <unordered_set>
#include <vector>

#include <barchan/core/brick/lane.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/strip_plan.hpp>
#include <barchan/tasks/world_setup.hpp>

namespace barchan {
namespace {

constexpr std::int64_t kChunkPairs = 4096;

std::vector<char> bonded_ones(const ParticleSet& set) {
  std::unordered_set<std::int64_t> ends;
  for (const BondData& bond : set.bonds) ends.insert({bond.id_a, bond.id_b});
  std::vector<char> is_bonded;
  is_bonded.reserve(set.particles.size());
  for (const ParticleData& p : set.particles) is_bonded.push_back(ends.contains(p.id) ? 1 : 0);
  return is_bonded;
}

/// One lane takes all cells, and has its lists made.
template <int Dim>
std::size_t bytes_of_lane(const Model& model, const ParticleSet& set) {
  World<Dim> world = make_world<Dim>(model, scale_of(model, set), vector_width("auto"));
  Lane<Dim> lane(world);
  const std::vector<double> lengths(set.bonds.size(), 0.0);  // take the same room
  lane.rebuild.seed({box_of_slabs(world.grid, 0, world.grid.num_slabs()), {}}, set.particles,
                    set.bonds, lengths, bonded_ones(set));
  lane.rebuild.order();
  lane.lists.list_owned();
  lane.rebuild.take_ghosts({});
  lane.rebuild.restore_history();
  lane.lists.cut_chunks(kChunkPairs);
  return lane.bytes();
}

}  // namespace

std::size_t memory_estimate(const Model& model, const ParticleSet& particles) {
  return model.dimension == 2 ? bytes_of_lane<2>(model, particles)
                              : bytes_of_lane<3>(model, particles);
}

}  // namespace barchan
