// Callbacks within run(): what Simulation asks of callers, and when the engine calls them.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/caller_checks.hpp>
#include <barchan/tasks/engine.hpp>

namespace barchan {
namespace {

/// @param every  0: not by steps
template <class... What>
void set(const Communicator& ranks, Callback<What...>& callback,
         std::type_identity_t<std::function<void(What...)>> call, std::int64_t every = 0) {
  const bool is_wanted = ranks.any_of(static_cast<bool>(call));
  callback = {std::move(call), is_wanted, every};
}

void require_every(const Communicator& ranks, const char* call, std::int64_t every) {
  require_same(ranks, call, Vec3(static_cast<double>(every), 0.0, 0.0));
  if (every < 1)
    throw InputError(fmt::format("Simulation::{}: every {} steps", call, every), "give 1 or more");
}

}  // namespace

void Simulation::on_step(std::int64_t every, std::function<void(const ParticleView&)> visit) {
  Engine& engine = between_steps("on_step");
  require_every(engine.communicator_, "on_step", every);
  set(engine.communicator_, engine.events_.step, std::move(visit), every);
}

void Simulation::on_step_together(std::int64_t every,
                                  std::function<void(std::span<const ParticleView>)> visit) {
  Engine& engine = between_steps("on_step_together");
  require_every(engine.communicator_, "on_step_together", every);
  set(engine.communicator_, engine.events_.step_together, std::move(visit), every);
}

void Simulation::on_progress(std::int64_t every, std::function<void(const RunProgress&)> tell) {
  Engine& engine = between_steps("on_progress");
  require_every(engine.communicator_, "on_progress", every);
  set(engine.communicator_, engine.events_.progress, std::move(tell), every);
}

void Simulation::on_note(std::function<void(const Note&)> tell) {
  Engine& engine = between_steps("on_note");
  set(engine.communicator_, engine.events_.note, std::move(tell));
}

void Simulation::on_checkpoint(std::function<void(const CheckpointEvent&)> tell) {
  Engine& engine = between_steps("on_checkpoint");
  set(engine.communicator_, engine.events_.checkpoint, std::move(tell));
}

void Simulation::on_bond_breaks(std::function<void(std::span<const BondBreak>)> tell) {
  Engine& engine = between_steps("on_bond_breaks");
  set(engine.communicator_, engine.events_.breaks, std::move(tell));
  engine.keep_breaks();
}

void Simulation::on_departure(std::function<void(std::span<const Departure>)> tell) {
  engine().population_.tell_departures = std::move(tell);
}

/// Does `work` while calls know that they come from a callback.
template <class Work>
void Simulation::Engine::tell(const char* event, Telling how, Work&& work) {
  telling_ = how;
  try {
    agree_between_steps(communicator_, fmt::format("step {}: {}", step_, event), work);
  } catch (...) {
    telling_ = Telling::Nothing;
    throw;
  }
  telling_ = Telling::Nothing;
}

template <int Dim>
void Simulation::EngineOf<Dim>::keep_breaks() {
  for (Lane<Dim>& lane : parts_.strip.lanes())
    lane.brick.bonds.keep_breaks(events_.breaks.is_wanted);
}

template <int Dim>
void Simulation::EngineOf<Dim>::visit_step() {
  if (events_.step.is_due(step_)) {
    tell("on_step", Telling::OnAllThreads, [&] {
      if (events_.step.call) for_each_view(events_.step.call);
    });
  }
  if (events_.step_together.is_due(step_)) {
    tell("on_step_together", Telling::OnOneThread, [&] {
      if (events_.step_together.call) events_.step_together.call(owned());
    });
  }
}

template <int Dim>
void Simulation::EngineOf<Dim>::tell_progress() {
  tell("on_progress", Telling::OnOneThread, [&] {
    if (events_.progress.call) events_.progress.call({step_, time()});
  });
}

/// All that broke, by step and ids, on rank 0. Collective.
template <int Dim>
std::vector<BondBreak> Simulation::EngineOf<Dim>::gather_breaks() {
  std::vector<BondBreak> mine;
  for (Lane<Dim>& lane : parts_.strip.lanes()) {
    const auto breaks = lane.brick.bonds.take_breaks();
    mine.insert(mine.end(), breaks.begin(), breaks.end());
  }
  if (!communicator_.any_of(!mine.empty())) return {};
  auto all = communicator_.gather_all(std::span<const BondBreak>(mine));
  std::sort(all.begin(), all.end(), [](const BondBreak& p, const BondBreak& q) {
    return std::tie(p.step, p.id_a, p.id_b) < std::tie(q.step, q.id_a, q.id_b);
  });
  return all;
}

template <int Dim>
void Simulation::EngineOf<Dim>::tell_news() {
  if (!events_.has_news()) return;
  std::vector<BondBreak> breaks;
  if (events_.breaks.is_wanted) breaks = gather_breaks();
  if (keeper_) keeper_->poll();
  const auto all = [&] {
    if (!breaks.empty() && events_.breaks.call) events_.breaks.call(breaks);
    if (events_.checkpoint.call && keeper_) {
      for (const CheckpointEvent& event : keeper_->take_events()) events_.checkpoint.call(event);
    }
    if (!events_.note.call) return;
    for (const Note& note : notes_.take()) events_.note.call(note);
  };
  tell("on_bond_breaks, on_checkpoint or on_note", Telling::OnOneThread, all);
}

template void Simulation::EngineOf<2>::keep_breaks();
template void Simulation::EngineOf<2>::visit_step();
template void Simulation::EngineOf<2>::tell_progress();
template void Simulation::EngineOf<2>::tell_news();
template void Simulation::EngineOf<3>::keep_breaks();
template void Simulation::EngineOf<3>::visit_step();
template void Simulation::EngineOf<3>::tell_progress();
template void Simulation::EngineOf<3>::tell_news();

}  // namespace barchan
