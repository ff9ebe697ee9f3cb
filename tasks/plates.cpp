#include <barchan/tasks/plates.hpp>

#include <algorithm>

#include <barchan/comm/clock.hpp>
#include <barchan/core/error.hpp>

namespace barchan {
namespace {

constexpr std::size_t kDigits = ExactSum::kDigits;

}  // namespace

Plates::Plates(const Communicator& communicator, std::span<const WallSpec> specs, double dt)
    : specs_(specs.begin(), specs.end()), dt_(dt) {
  for (std::size_t w = 0; w < specs.size(); ++w) {
    if (specs[w].is_loaded) loaded_.push_back(w);
  }
  of_step_.fill(-1);
  if (loaded_.empty()) return;
  for (auto& reduction : reductions_)
    reduction = std::make_unique<Reduction>(communicator, 0, 3 * kDigits * loaded_.size());
}

bool Plates::needs_forces(std::span<const WallState> states) const {
  return std::any_of(loaded_.begin(), loaded_.end(),
                     [&](std::size_t w) { return states[w].is_active; });
}

void Plates::drive(std::span<WallState> states, std::int64_t step) {
  if (loaded_.empty()) return;
  const auto slot = static_cast<std::size_t>(step % kLag);
  const bool has_forces = step >= kLag && of_step_[slot] == step - kLag;
  if (has_forces) {
    const std::int64_t begin = now_ns();
    reductions_[slot]->wait();
    wait_seconds_ += 1e-9 * static_cast<double>(now_ns() - begin);
  }
  for (std::size_t p = 0; p < loaded_.size(); ++p) {
    const std::size_t w = loaded_[p];
    if (!states[w].is_active) continue;
    Vec3 force = Vec3::Zero();
    for (int c = 0; c < 3 && has_forces; ++c) {
      ExactSum sum;
      const auto digits = reductions_[slot]->sums().subspan(
          (3 * p + static_cast<std::size_t>(c)) * kDigits, kDigits);
      std::copy(digits.begin(), digits.end(), sum.digits().begin());
      force[c] = sum.value();
    }
    accelerate(states[w], specs_[w], force);
  }
}

void Plates::accelerate(WallState& state, const WallSpec& spec, const Vec3& force) const {
  const Vec3& n = spec.normal;
  const double area = spec.depth > 0.0 ? spec.width * spec.depth : spec.width;
  const double speed =
      state.velocity[0] * n[0] + state.velocity[1] * n[1] + state.velocity[2] * n[2];
  const double push = force[0] * n[0] + force[1] * n[1] + force[2] * n[2];
  // A plate loaded by q presses in the direction of its normal, towards the particles.
  const double drive = push + spec.load * area - spec.damping * speed;
  const double faster = speed + dt_ * drive / spec.mass;
  state.velocity = faster * n;
}

void Plates::collect(std::span<const WallSums> sums, std::int64_t step) {
  if (loaded_.empty()) return;
  std::vector<std::int64_t> digits;
  for (const std::size_t w : loaded_) {
    for (int c = 0; c < 3; ++c) {
      ExactSum sum;
      if (!sums.empty()) sum = sums[w].force[c];
      digits.insert(digits.end(), sum.digits().begin(), sum.digits().end());
    }
  }
  const auto slot = static_cast<std::size_t>(step % kLag);
  reductions_[slot]->begin({}, digits);
  of_step_[slot] = step;
}

void Plates::move(std::span<WallState> states) const {
  for (WallState& state : states) {
    if (state.is_active) state.point += dt_ * state.velocity;
  }
}

std::vector<SavedPlateForces> Plates::forces() {
  std::vector<SavedPlateForces> saved(kLag);
  for (std::size_t slot = 0; slot < saved.size(); ++slot) {
    saved[slot].of_step = of_step_[slot];
    if (of_step_[slot] < 0) continue;
    reductions_[slot]->wait();
    const auto sums = reductions_[slot]->sums();
    saved[slot].digits.assign(sums.begin(), sums.end());
  }
  return saved;
}

void Plates::restore(std::span<const SavedPlateForces> forces, bool is_root) {
  if (forces.size() != kLag)
    throw RunError("the checkpoint has forces on plates of another number of steps");
  const std::size_t num_digits = 3 * kDigits * loaded_.size();
  for (std::size_t slot = 0; slot < forces.size(); ++slot) {
    of_step_[slot] = forces[slot].of_step;
    if (of_step_[slot] < 0) continue;
    if (loaded_.empty() || forces[slot].digits.size() != num_digits) {
      throw RunError("the checkpoint has forces on another number of loaded plates");
    }
    const std::vector<std::int64_t> none(num_digits, 0);
    reductions_[slot]->begin({}, is_root ? forces[slot].digits : none);
  }
}

}  // namespace barchan
