#include <barchan/core/brick/dissipation.hpp>

#include <algorithm>
#include <cmath>

#include <barchan/core/kernels/batch_scalar.hpp>

namespace barchan {
namespace {

template <int Dim>
TurningPair<simd::Scalar, Dim> pair_of(const PairJob& pairs, std::int64_t k) {
  TurningPair<simd::Scalar, Dim> pair;
  kernels::BatchScalar::gather(pairs, k, pair);
  pair.dx = pairs.box.nearest(pair.dx, 0);
  pair.dy = pairs.box.nearest(pair.dy, 1);
  if constexpr (Dim == 3) pair.dz = pairs.box.nearest(pair.dz, 2);
  return pair;
}

/// With the last bit set no sum with a multiple of the grain is a tie.
template <int Dim>
void warm_by(ParticleStore<Dim>& store, std::int32_t row, double heat, double dt) {
  const double flow = simd::Scalar::odd(heat / dt);
  store.q(row)[0] += flow, store.q(row)[1] += std::abs(flow);
}

}  // namespace

template <int Dim>
void dissipate(Brick<Dim>& brick, const PairJob& pairs, double kick, bool counts) {
  const World<Dim>& world = *brick.world;
  const LawTable& laws = world.laws;
  const ContactLawIn<Dim>& law = laws.law().template in<Dim>();
  const bool books = world.accounts && counts;
  if (law.losses == nullptr || !(books || world.heat.dissipates)) return;
  const int length = law.history.length;
  double history[kMostHistory];
  for (std::int64_t k = pairs.begin; k < pairs.end; ++k) {
    if (pairs.code[k] == LawTable::kBonded) continue;
    const auto pair = pair_of<Dim>(pairs, k);
    double d2 = pair.dx * pair.dx + pair.dy * pair.dy;
    if constexpr (Dim == 3) d2 += pair.dz * pair.dz;
    const double reach = pair.reach + world.range;
    if (!(d2 < reach * reach)) continue;
    const double* numbers = pairs.history + k / kBatch * kBatch * length + k % kBatch;
    for (int c = 0; c < length; ++c) history[c] = numbers[c * kBatch];
    const Losses losses =
        law.losses(laws.level(), laws.row(pairs.code[k]), pair, {pairs.dt, kick}, history);
    if (books) brick.works.add(losses);
    if (!world.heat.dissipates) continue;
    for (const std::int32_t row : {pairs.i[k], pairs.j[k]})
      warm_by(brick.store, row, 0.5 * losses.sum(), world.dt);
  }
}

template <int Dim>
void dissipate(Brick<Dim>& brick, std::span<const WallLoss> losses) {
  const World<Dim>& world = *brick.world;
  for (const WallLoss& loss : losses) {
    if (world.accounts) brick.works.add(loss.losses);
    if (world.heat.dissipates) warm_by(brick.store, loss.row, loss.losses.sum(), world.dt);
  }
}

template void dissipate(Brick<2>&, const PairJob&, double, bool);
template void dissipate(Brick<3>&, const PairJob&, double, bool);
template void dissipate(Brick<2>&, std::span<const WallLoss>);
template void dissipate(Brick<3>&, std::span<const WallLoss>);

}  // namespace barchan
