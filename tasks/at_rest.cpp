#include <barchan/tasks/at_rest.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include <barchan/tasks/view.hpp>

namespace barchan {
namespace {

struct Mover {
  std::int64_t id;
  std::int32_t type, is_fixed;
  double radius, density, mass, position[3];
};
struct Tie {
  std::int64_t id_a, id_b;
  std::int32_t law, padding;
  double length;
};

template <int Dim>
std::vector<Mover> movers_of(const RunParts<Dim>& run) {
  std::vector<Mover> movers;
  for_each_owned(run.strip, [&](const OwnedParticle& p) {
    movers.push_back({p.id,
                      p.type,
                      p.fixed ? 1 : 0,
                      p.radius,
                      p.density,
                      p.mass,
                      {p.position[0], p.position[1], p.position[2]}});
  });
  return movers;
}

/// On rank 0. Collective.
ParticleSet gather(const Communicator& communicator, const std::vector<Mover>& movers) {
  ParticleSet all;
  for (const Mover& m : communicator.gather_all(std::span<const Mover>(movers))) {
    ParticleData& p = all.particles.emplace_back();
    p.id = m.id;
    p.type = m.type;
    p.fixed = m.is_fixed != 0;
    p.radius = m.radius;
    p.density = m.density;
    p.position = Vec3(m.position[0], m.position[1], m.position[2]);
  }
  return all;
}

bool do_numbers_count(const Model& model) {
  return model.heat.is_on || std::any_of(model.walls.begin(), model.walls.end(),
                                         [](const WallSpec& wall) { return wall.is_loaded; });
}

}  // namespace

template <int Dim>
ParticleSet gather_at_rest(const RunParts<Dim>& run) {
  std::vector<Tie> ties;
  for (const Lane<Dim>& lane : run.strip.lanes()) {
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(lane.brick.bonds.bonds().size()); ++b) {
      const Bond<Dim>& bond = lane.brick.bonds.bonds()[static_cast<std::size_t>(b)];
      if (lane.brick.counts_bond(b))
        ties.push_back({bond.id_a, bond.id_b, bond.law, 0, bond.length});
    }
  }
  ParticleSet all = gather(run.communicator, movers_of(run));
  for (const Tie& t : run.communicator.gather_all(std::span<const Tie>(ties))) {
    BondData& bond = all.bonds.emplace_back();
    bond.id_a = t.id_a;
    bond.id_b = t.id_b;
    bond.law = t.law;
    bond.length = t.length;
  }
  return all;
}

template <int Dim>
ParticleSet gather_lightest(const RunParts<Dim>& run) {
  std::vector<Mover> movers = movers_of(run);
  if (!do_numbers_count(run.model)) {
    std::sort(movers.begin(), movers.end(), [](const Mover& p, const Mover& q) {
      return std::tie(p.type, p.mass, p.id) < std::tie(q.type, q.mass, q.id);
    });
    std::size_t kept = 0;
    for (const Mover& m : std::vector<Mover>(movers)) {
      if (kept < 2 || movers[kept - 2].type != m.type) movers[kept++] = m;
    }
    movers.resize(kept);
  }
  return gather(run.communicator, movers);
}

template ParticleSet gather_at_rest(const RunParts<2>&);
template ParticleSet gather_at_rest(const RunParts<3>&);
template ParticleSet gather_lightest(const RunParts<2>&);
template ParticleSet gather_lightest(const RunParts<3>&);

}  // namespace barchan
