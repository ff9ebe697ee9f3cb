// A state in memory and back: State of state.hpp.
#include <stdexcept>

#include <fmt/format.h>

#include <barchan/tasks/engine.hpp>

namespace barchan {

State::State() = default;
State::~State() = default;
State::State(State&&) noexcept = default;
State& State::operator=(State&&) noexcept = default;
bool State::is_empty() const {
  return data_ == nullptr;
}
std::int64_t State::step() const {
  if (is_empty()) throw std::logic_error("State::step: the state is empty: save to it first");
  return data_->step;
}
std::size_t State::bytes() const {
  return is_empty() ? 0 : data_->bytes();
}

template <int Dim>
std::size_t StateOf<Dim>::bytes() const {
  std::size_t n = sizeof(*this) + sizeof(Brick<Dim>) * bricks.capacity();
  for (const Brick<Dim>& brick : bricks) n += bytes_of(brick);
  return n;
}

template <int Dim>
void Simulation::EngineOf<Dim>::save(std::unique_ptr<State::Data>& state) {
  if (state == nullptr || !state->owner.is_of(generation_))
    state = std::make_unique<StateOf<Dim>>(generation_);
  auto& s = static_cast<StateOf<Dim>&>(*state);
  Strip<Dim>& strip = parts_.strip;
  strip.complete_halo();
  while (s.bricks.size() < strip.lanes().size()) s.bricks.emplace_back(parts_.world);
  graph_.for_each_lane([&](int l) {
    Brick<Dim>& copy = s.bricks[static_cast<std::size_t>(l)];
    copy = strip.lane(l).brick;
    for (WallSums& sums : copy.wall_sums) sums.work.carry();  // as after carries of the step
    for (ExactSum& sum : copy.works.sums) sum.carry();
  });
  s.step = step_;
  s.cuts = parts_.rebuild.cuts();
  s.walls = parts_.world.walls;
  s.walls_at_renewal = lists_.walls_at_renewal();
  s.loads.clear();
  s.normals.clear();
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    s.loads.push_back(plates_.load(w));
    s.normals.push_back(model_.walls[w].normal);
  }
  s.gravity = model_.gravity;
  s.contacts = model_.contacts;
  s.schedule = schedule_.memory(step_);
  stages_.save(s.stages);
  s.since = since_;
  s.dt = s.stages.last_dt = parts_.world.dt;
  s.last_dt = parts_.world.last_dt;
  s.num_particles = population_.size;
  s.left = population_.left;
  s.watch = watch_.memory();
  s.skin = parts_.world.skin;
  s.quick_travel = parts_.world.quick_travel;
  s.is_over = is_over_;
  s.has_account = has_account_;
}

template <int Dim>
void Simulation::EngineOf<Dim>::load(const State::Data& state) {
  const auto& s = static_cast<const StateOf<Dim>&>(state);
  Strip<Dim>& strip = parts_.strip;
  strip.complete_halo();  // takes what is on its way
  graph_.for_each_lane([&](int l) {
    Brick<Dim>& brick = strip.lane(l).brick;
    brick = s.bricks[static_cast<std::size_t>(l)];
    brick.store.set_num_carried(parts_.world.num_carried);  // fields that came later are zero
  });
  keep_breaks();
  generation_.advance();
  schedule_.recall(step_, s.schedule);
  step_ = s.step;
  parts_.rebuild.set_cuts(s.cuts);
  parts_.world.walls = s.walls;
  lists_.recall(s.walls_at_renewal);
  strip.forget_shadows();
  if (parts_.lanes.shape().depth > 0) lists_.demand();
  for (std::size_t w = 0; w < s.walls.size(); ++w) {
    set_wall_load(w, s.loads[w]);
    if (s.normals[w] != model_.walls[w].normal) turn_wall(w, s.normals[w]);
  }
  model_.gravity = s.gravity;
  if (has_new_contacts_) take_contacts(s.contacts);
  stages_.restore(s.stages);
  since_ = s.since;
  model_.time.step = parts_.world.dt = s.dt;
  parts_.world.last_dt = s.last_dt;
  population_.size = s.num_particles;
  population_.left = s.left;
  watch_.recall(s.watch);
  parts_.world.skin = s.skin;
  parts_.world.quick_travel = s.quick_travel;
  is_over_ = s.is_over;
  has_account_ = s.has_account;
  stopped_ = false;
  failure_ = nullptr;
  if (keeper_) keeper_->forget_course();
}

template void Simulation::EngineOf<2>::save(std::unique_ptr<State::Data>&);
template void Simulation::EngineOf<2>::load(const State::Data&);
template void Simulation::EngineOf<3>::save(std::unique_ptr<State::Data>&);
template void Simulation::EngineOf<3>::load(const State::Data&);

}  // namespace barchan
