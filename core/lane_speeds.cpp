#include <cmath>
#include <limits>

#include <barchan/core/lane.hpp>

// How far rows move in a step, and what they may pass (passage.hpp). Where nothing moves farther
// than half of the smallest radius, a look at each component of velocity is all that this costs.

namespace barchan {

/// How far a row moved in its last step [m]; not a number where its state is none.
template <int Dim>
double Lane<Dim>::step_travel(std::int32_t row) const {
  const double *x = store_.x(row), *v = store_.v(row), *u = store_.u(row);
  double v2 = 0.0, zero = 0.0;
  for (int c = 0; c < Dim; ++c) v2 += v[c] * v[c], zero += 0.0 * x[c];
  for (int c = 0; c < kSpins<Dim>; ++c) zero += 0.0 * u[c];
  return std::sqrt(v2) * world_->dt + zero;
}

/// Infinite where a state is not a number.
template <int Dim>
double Lane<Dim>::fastest_travel(Rows rows) const {
  double most = 0.0;
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    const double travel = step_travel(i);
    if (!(travel <= most))
      most = std::isnan(travel) ? std::numeric_limits<double>::infinity() : travel;
  }
  return most;
}

template <int Dim>
void Lane<Dim>::judge_speeds(Rows rows) {
  const double travel = fastest_travel(rows);
  is_beyond_ = is_beyond_ || is_beyond(travel);
  has_quick_ = has_quick_ || travel > world_->quick_travel;
}

/// After rows have come and gone, and lists have another skin.
template <int Dim>
void Lane<Dim>::find_quick() {
  has_quick_ = false;
  judge_speeds({0, store_.num_owned});
  for (const Side side : {Left, Right}) {
    const std::int32_t begin = store_.ghost_begin(side);
    const Rows ghosts{begin, begin + store_.num_ghosts[static_cast<std::size_t>(side)]};
    bands_[side].has_quick = fastest_travel(ghosts) > world_->quick_travel;
  }
}

template <int Dim>
void Lane<Dim>::look_for_passages() {
  if (looks_) PassageWatch<Dim>(*world_, store_, passage_).look_at(pairs_);
}

template <int Dim>
void Lane<Dim>::look_for_passages(Side side) {
  const Band& band = bands_[side];
  if (looks_ || (band.has_quick && frame_.has_moved(world_->dt)))
    PassageWatch<Dim>(*world_, store_, passage_).look_at(band.across);
}

template class Lane<2>;
template class Lane<3>;

}  // namespace barchan
