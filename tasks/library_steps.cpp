// Steps of other lengths and other contacts, as callers want them; what acts in contacts and bonds.
#include <span>
#include <utility>
#include <vector>

#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/links.hpp>
#include <barchan/core/model/contact_range.hpp>
#include <barchan/core/model/validate.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/at_rest.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/stability.hpp>

namespace barchan {
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
