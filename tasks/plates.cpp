#include <barchan/tasks/plates.hpp>

#include <algorithm>

#include <barchan/core/base/clock.hpp>

namespace barchan {
namespace {

constexpr std::size_t kDigits = ExactSum::kDigits;

double along(const Vec3& v, const Vec3& n) {
  return v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
}

/// Kicks a plate over a time h. @return the work of the plate on the particles [J]
double kick_plate(WallState& state, const WallSpec& spec, const Vec3& force, double h) {
  const Vec3& n = spec.normal;
  const double area = spec.depth > 0.0 ? spec.width * spec.depth : spec.width;
  const double before = along(state.velocity, n);
  const double push = along(force, n);
  // A plate loaded by q presses in the direction of its normal, towards the particles.
  const double drag = 0.5 * h * spec.damping / spec.mass;
  const double after =
      ((1.0 - drag) * before + h * (push + spec.load * area) / spec.mass) / (1.0 + drag);
  state.velocity = after * n;
  return -push * 0.5 * (before + after) * h;
}

}  // namespace

Plates::Plates(const Communicator& communicator, std::span<const WallSpec> specs, double dt)
    : specs_(specs.begin(), specs.end()), last_dt_(dt), dt_(dt) {
  for (std::size_t w = 0; w < specs.size(); ++w) {
    if (specs[w].is_loaded) loaded_.push_back(w);
  }
  if (loaded_.empty()) return;
  digits_.resize(3 * kDigits * loaded_.size());
  reduction_ = std::make_unique<Reduction>(communicator, 0, digits_.size());
}

bool Plates::are_driven(std::span<const WallState> states) const {
  return std::any_of(loaded_.begin(), loaded_.end(),
                     [&](std::size_t w) { return states[w].is_active; });
}

bool Plates::stand_still(std::span<const WallState> states) const {
  return !are_driven(states) && std::ranges::all_of(states, [](const WallState& wall) {
    return !wall.is_active || wall.velocity == Vec3::Zero();
  });
}

std::span<WallSums> Plates::start_sums() {
  sums_.assign(specs_.size(), WallSums());
  return sums_;
}

void Plates::begin(std::span<const WallSums> sums) {
  auto to = digits_.begin();
  for (const std::size_t w : loaded_) {
    for (const ExactSum& component : sums[w].force)
      to = std::copy(component.digits().begin(), component.digits().end(), to);
  }
  reduction_->begin({}, digits_);
}

Vec3 Plates::force_on(std::size_t plate) const {
  Vec3 force = Vec3::Zero();
  for (int c = 0; c < 3; ++c) {
    ExactSum sum;
    const auto digits =
        reduction_->sums().subspan((3 * plate + static_cast<std::size_t>(c)) * kDigits, kDigits);
    std::copy(digits.begin(), digits.end(), sum.digits().begin());
    force[c] = sum.value();
  }
  return force;
}

void Plates::kick(std::span<WallState> states, int appears_in, std::span<WallSums> works) {
  const std::int64_t begin = now_ns();
  reduction_->wait();
  wait_seconds_ += seconds_since(begin);
  for (std::size_t p = 0; p < loaded_.size(); ++p) {
    const std::size_t w = loaded_[p];
    if (!states[w].is_active) continue;
    const double last = specs_[w].from_stage == appears_in ? 0.0 : last_dt_;
    const double work = kick_plate(states[w], specs_[w], force_on(p), 0.5 * last + 0.5 * dt_);
    if (!works.empty()) works[w].work.add(work);
  }
}

void Plates::move(std::span<WallState> states) const {
  for (WallState& state : states) {
    if (state.is_active) state.point += dt_ * state.velocity;
  }
}

}  // namespace barchan
