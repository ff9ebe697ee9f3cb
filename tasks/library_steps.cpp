// Steps of other lengths and other contacts, as callers want them; what acts in contacts and bonds.
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/links.hpp>
#include <barchan/core/model/contact_range.hpp>
#include <barchan/core/model/validate.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/stability.hpp>

namespace barchan {
namespace {

/// What limits the step.
struct Mover {
  std::int64_t id;
  std::int32_t type, is_fixed;
  double radius, density, position[3];
};
struct Tie {
  std::int64_t id_a, id_b;
  std::int32_t law, padding;
  double length;
};

/// All particles at rest and all bonds, on rank 0. Collective.
template <int Dim>
ParticleSet gather_at_rest(const RunParts<Dim>& run) {
  std::vector<Mover> movers;
  std::vector<Tie> ties;
  for_each_owned(run.strip, [&](const OwnedParticle& p) {
    movers.push_back({p.id,
                      p.type,
                      p.fixed ? 1 : 0,
                      p.radius,
                      p.density,
                      {p.position[0], p.position[1], p.position[2]}});
  });
  for (const Lane<Dim>& lane : run.strip.lanes()) {
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(lane.brick.bonds.bonds().size()); ++b) {
      const Bond<Dim>& bond = lane.brick.bonds.bonds()[static_cast<std::size_t>(b)];
      if (lane.brick.counts_bond(b))
        ties.push_back({bond.id_a, bond.id_b, bond.law, 0, bond.length});
    }
  }
  ParticleSet all;
  for (const Mover& m : run.communicator.gather_all(std::span<const Mover>(movers))) {
    ParticleData& p = all.particles.emplace_back();
    p.id = m.id;
    p.type = m.type;
    p.fixed = m.is_fixed != 0;
    p.radius = m.radius;
    p.density = m.density;
    p.position = Vec3(m.position[0], m.position[1], m.position[2]);
  }
  for (const Tie& t : run.communicator.gather_all(std::span<const Tie>(ties))) {
    BondData& bond = all.bonds.emplace_back();
    bond.id_a = t.id_a;
    bond.id_b = t.id_b;
    bond.law = t.law;
    bond.length = t.length;
  }
  return all;
}

}  // namespace

/// Errors: InputError on every rank: the step of `wanted` is too long for it. Collective.
template <int Dim>
void Simulation::EngineOf<Dim>::check_step(const Model& wanted) {
  const ParticleSet all = gather_at_rest(parts_);
  agree(communicator_, [&] {
    if (communicator_.is_root()) check_time_step(wanted, step_limits(wanted, all));
  });
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_time_step(double dt) {
  Model wanted = model_;
  wanted.time.step = dt;
  wanted.time.place = {};
  check_step(wanted);
  since_ = {time(), step_};
  stages_.count_from(step_);
  model_.time.step = parts_.world.dt = dt;
  if (step_ == 0) parts_.world.last_dt = dt;
  schedule_.set_step_length(dt);
  schedule_.amend(step_, 0, 0.0);
  renew_lists();
}

template <int Dim>
void Simulation::EngineOf<Dim>::take_contacts(const ContactTable& contacts) {
  World<Dim>& world = parts_.world;
  model_.contacts = contacts;
  world.laws = LawTable(contacts);
  world.kernels =
      make_kernels(Dim, world.kernels.width, world.laws, parts_.scale.has_bonds, world.grid.box());
}

template <int Dim>
void Simulation::EngineOf<Dim>::set_contacts(const ContactTable& contacts) {
  Model wanted = model_;
  wanted.contacts = contacts;
  if (const auto fault = find_fault(wanted))
    throw InputError("Simulation::set_contact: " + fault->what, fault->remedy);
  if (contact_range_within(contacts, parts_.scale.reach - parts_.scale.skin) >
      parts_.world.range * (1.0 + 1e-12))
    throw InputError(
        "Simulation::set_contact: contacts would hold farther beyond touch than those of the start",
        "begin with the ones that reach farthest");
  check_step(wanted);
  has_new_contacts_ = true;
  book_elastic([&] { take_contacts(contacts); });
}

/// Others count on steps of the model's length, so that this one moves particles less than they
/// allow for.
template <int Dim>
std::int64_t Simulation::EngineOf<Dim>::run_short(double end) {
  const double begin = time();
  double& dt = parts_.world.dt;
  dt = end - begin;
  const double length = dt;
  std::int64_t done = 0;
  try {
    done = run(1);
  } catch (...) {
    dt = model_.time.step;
    throw;
  }
  dt = model_.time.step;
  if (done == 0) return 0;
  stages_.count_short(step_, length);
  since_ = {end, step_};
  return done;
}

template <int Dim>
std::vector<LinkForce> Simulation::EngineOf<Dim>::links(LinkKind kind) {
  parts_.strip.complete_halo();
  std::vector<LinkForce> all;
  for (const Lane<Dim>& lane : parts_.strip.lanes())
    list_links(lane.brick, kind, step_ == 0 ? 0.0 : parts_.world.last_dt, all);
  return all;
}

template void Simulation::EngineOf<2>::check_step(const Model&);
template void Simulation::EngineOf<2>::take_contacts(const ContactTable&);
template void Simulation::EngineOf<2>::set_contacts(const ContactTable&);
template void Simulation::EngineOf<2>::set_time_step(double);
template std::int64_t Simulation::EngineOf<2>::run_short(double);
template std::vector<LinkForce> Simulation::EngineOf<2>::links(LinkKind);
template void Simulation::EngineOf<3>::check_step(const Model&);
template void Simulation::EngineOf<3>::take_contacts(const ContactTable&);
template void Simulation::EngineOf<3>::set_contacts(const ContactTable&);
template void Simulation::EngineOf<3>::set_time_step(double);
template std::int64_t Simulation::EngineOf<3>::run_short(double);
template std::vector<LinkForce> Simulation::EngineOf<3>::links(LinkKind);

}  // namespace barchan
