#include <string>

#include <barchan/core/brick/halo.hpp>
#include <barchan/core/particles/fields.hpp>
#include <barchan/core/simd/denormals.hpp>

#include "law_cost.hpp"
#include "sample.hpp"
#include "suites.hpp"

// Pairs, narrow phase, rows, halo records and whole steps of one thread. Nothing moves while a
// kernel is measured.

namespace barchan::micro {
namespace {

/// A copy of a lane's pairs to work on: all candidates, or those that touch.
template <int Dim>
struct Pairs {
  AlignedVector<std::int32_t> i, j;
  AlignedVector<std::uint8_t> code, masks;
  AlignedVector<double> spring;

  Pairs(Lane<Dim>& lane, bool only_touching) {
    const PairList& list = lane.brick.pairs;
    for (std::size_t k = 0; k < list.i.size(); ++k) {
      if (only_touching && !touches(lane.brick.store, list.i[k], list.j[k])) continue;
      i.push_back(list.i[k]);
      j.push_back(list.j[k]);
      code.push_back(list.code[k]);
    }
    while (i.size() % kBatch != 0) {
      i.push_back(lane.brick.store.waste());
      j.push_back(lane.brick.store.waste() + 1);
      code.push_back(0);
    }
    masks.resize(i.size() / 8);
    spring.assign(i.size() * LinearSpring::kHistory<Dim>.length, 0.0);
  }

  static bool touches(const ParticleStore<Dim>& store, std::int32_t a, std::int32_t b) {
    double d2 = 0.0;
    for (int c = 0; c < Dim; ++c) {
      const double d = store.x(b)[c] - store.x(a)[c];
      d2 += d * d;
    }
    const double reach = store.radius(a) + store.radius(b);
    return d2 < reach * reach;
  }

  PairJob job(Lane<Dim>& lane) {
    auto& store = lane.brick.store;
    PairJob job;
    job.motion = store.motion.data();
    job.spin = store.spin.data();
    job.force = store.force.data();
    job.i = i.data();
    job.j = j.data();
    job.code = code.data();
    job.history = spring.data();
    job.end = static_cast<std::int64_t>(i.size());
    job.dt = lane.brick.world->dt;
    job.box = lane.brick.world->grid.box();
    job.laws = lane.brick.world->laws.view();
    return job;
  }
};

constexpr double record_bytes(int dim) {
  return dim == 2 ? 64.0 : 96.0;
}
constexpr double force_bytes(int dim) {
  return dim == 2 ? 32.0 : 64.0;
}

/// Lists and springs stream; records and forces come once a particle, but are loaded once a pair
/// and side.
template <int Dim>
ItemCost pair_cost(double pairs, double particles) {
  const double listed = 9.0 + 2.0 * 8.0 * LinearSpring::kHistory<Dim>.length;
  const double per_particle = record_bytes(Dim) + 2.0 * force_bytes(Dim);
  return {listed + per_particle * particles / pairs, listed + 2.0 * per_particle, law_flops(Dim)};
}

template <int Dim>
void pairs(benchmark::State& state, VectorWidth width) {
  const auto sample = make_sample<Dim>(state.range(0), width);
  Lane<Dim>& lane = *sample->lane;
  Pairs<Dim> list(lane, Dim == 3);
  const PairJob job = list.job(lane);
  const simd::DenormalsAreZero quiet;  // as in a step
  for (auto _ : state) lane.brick.world->kernels.pairs(job);
  const auto n = static_cast<double>(list.i.size());
  report(state, n, pair_cost<Dim>(n, static_cast<double>(state.range(0))));
}

template <int Dim>
void narrow(benchmark::State& state, VectorWidth width) {
  const auto sample = make_sample<Dim>(state.range(0), width);
  Lane<Dim>& lane = *sample->lane;
  Pairs<Dim> list(lane, false);
  const PairJob job = list.job(lane);
  if (lane.brick.world->kernels.narrow == nullptr)
    return state.SkipWithError("this width has no narrow phase of its own");
  for (auto _ : state) lane.brick.world->kernels.narrow(job, 0.0, list.masks.data());
  const auto n = static_cast<double>(list.i.size());
  report(state, n,
         {8.125 + 64.0 * static_cast<double>(state.range(0)) / n, 8.125 + 64.0,
          Dim == 2 ? 7.0 : 10.0});
}

template <int Dim>
void rows(benchmark::State& state, VectorWidth width) {
  const auto sample = make_sample<Dim>(state.range(0), width);
  auto& store = sample->lane->brick.store;
  RowJob job;
  job.motion = store.motion.data();
  job.spin = store.spin.data();
  job.force = store.force.data();
  job.end = store.num_owned;
  job.kick = job.dt = 1e-9;
  for (auto _ : state) sample->world.kernels.rows(job);
  const double bytes = 2.0 * (record_bytes(Dim) + force_bytes(Dim));
  report(state, static_cast<double>(store.num_owned), {bytes, bytes, Dim == 2 ? 15.0 : 27.0});
}

/// A whole step, per particle. @param width  of vectors
template <int Dim>
void steps(benchmark::State& state, VectorWidth width) {
  const auto sample = make_sample<Dim>(state.range(0), width);
  for (auto _ : state) step(*sample->lane);
  const auto n = static_cast<double>(state.range(0)),
             touching = static_cast<double>(sample->touching);
  const ItemCost pair = pair_cost<Dim>(touching, n);
  const double rows = 2.0 * (record_bytes(Dim) + force_bytes(Dim));
  report(state, n,
         {(9.0 + 16.0 * LinearSpring::kHistory<Dim>.length) * touching / n + rows,
          pair.cache_bytes * touching / n + rows,
          pair.flops * touching / n + (Dim == 2 ? 15.0 : 27.0)});
  state.counters["contacts_each"] = touching / n;
}

template <int Dim>
void pack_halo(benchmark::State& state) {
  const auto sample = make_sample<Dim>(state.range(0), VectorWidth::Scalar, true);
  std::vector<std::byte> message(halo_bytes(sample->lane->brick, 0));
  for (auto _ : state) {
    pack_halo(sample->lane->brick, 0, message);
    benchmark::ClobberMemory();
  }
  const double record = double{halo_record_bytes<Dim>()}, bytes = record_bytes(Dim) + record;
  report(state, static_cast<double>(message.size()) / record, {bytes, 2.0 * record, 0.0});
}

template <int Dim>
void unpack_halo(benchmark::State& state) {
  const auto sample = make_sample<Dim>(state.range(0), VectorWidth::Scalar, true);
  std::vector<std::byte> message(halo_bytes(sample->right->brick, 0));
  pack_halo(sample->right->brick, 0, message);
  for (auto _ : state) {
    unpack_halo(sample->lane->brick, 0, message);
    benchmark::ClobberMemory();
  }
  const double record = double{halo_record_bytes<Dim>()}, bytes = 2.0 * record_bytes(Dim) + record;
  report(state, static_cast<double>(message.size()) / record, {bytes, 2.0 * record, 0.0});
}

constexpr std::int64_t kSmall2 = 5000, kSmall3 = 30000, kLarge = 200000;

template <int Dim>
void add(VectorWidth width) {
  const std::string d = Dim == 2 ? "_2d/" : "_3d/", w = name_of(width);
  const std::int64_t small = Dim == 2 ? kSmall2 : kSmall3;
  const auto of = [&](const char* name, void (*run)(benchmark::State&, VectorWidth)) {
    benchmark::RegisterBenchmark((name + d + w).c_str(),
                                 [run, width](benchmark::State& s) { run(s, width); })
        ->Arg(small)
        ->Arg(kLarge);
  };
  of("pairs", &pairs<Dim>);
  if (Dim == 3 && width != VectorWidth::Scalar) of("narrow", &narrow<Dim>);
  if (width != VectorWidth::Avx512) of("rows", &rows<Dim>);
  of("step", &steps<Dim>);
}

}  // namespace

void add_kernels() {
  for (const VectorWidth width : vector_widths()) {
    add<2>(width);
    add<3>(width);
  }
  benchmark::RegisterBenchmark("pack_halo_2d", pack_halo<2>)->Arg(kLarge);
  benchmark::RegisterBenchmark("pack_halo_3d", pack_halo<3>)->Arg(kLarge);
  benchmark::RegisterBenchmark("unpack_halo_2d", unpack_halo<2>)->Arg(kLarge);
  benchmark::RegisterBenchmark("unpack_halo_3d", unpack_halo<3>)->Arg(kLarge);
}

}  // namespace barchan::micro
