#include <barchan/core/particles/particle_store.hpp>

#include <algorithm>
#include <utility>

#include <barchan/core/particles/row_record.hpp>

namespace barchan {

template <int Dim>
void ParticleStore<Dim>::set_num_carried(std::int32_t n) {
  if (n == num_carried) return;
  const std::size_t rows = id.size(), before = static_cast<std::size_t>(num_carried),
                    now = static_cast<std::size_t>(n);
  AlignedVector<double> wider(rows * now, 0.0);
  for (std::size_t row = 0; row < rows && before > 0; ++row)
    std::copy_n(carried.data() + row * before, before, wider.data() + row * now);
  carried = std::move(wider);
  num_carried = n;
}

template <int Dim>
void ParticleStore<Dim>::resize_rows(std::size_t n) {
  for_each_array<Dim>([&](const auto& array) {
    if (!array.is_optional && (has_heat || !array.is_of_heat))
      resize_with_room(this->*array.values, n * static_cast<std::size_t>(array.width));
  });
  if (num_carried > 0) resize_with_room(carried, n * static_cast<std::size_t>(num_carried));
}

template <int Dim>
void ParticleStore<Dim>::resize_for_ghosts(double rounder, double heat_rounder) {
  const auto n = static_cast<std::size_t>(size());
  resize_rows(n);
  resize_with_room(force, n * L::kForce);
  start_forces(rounder, 0, size());
  if (has_heat) {
    resize_with_room(heat_flow, n * 2);
    start_flows(heat_rounder, 0, size());
  }
  for (std::int32_t w = waste(); w < waste() + 2; ++w) {
    RowRecord<Dim>().put(*this, w);
    x(w)[0] = -1e9 * (1 + w - waste());
    x(w)[L::kInverseMass] = 1.0;
    (Dim == 2 ? x(w) : u(w))[L::kInverseRadius] = 1.0;
    id[static_cast<std::size_t>(w)] = key[static_cast<std::size_t>(w)] = -1;
  }
}

template <int Dim>
void ParticleStore<Dim>::start_forces(double rounder, std::int32_t begin, std::int32_t end) {
  for (double *f = this->f(begin), *last = this->f(end); f != last; f += 4)
    f[0] = f[1] = f[2] = rounder, f[3] = 0.0;
}

template <int Dim>
void ParticleStore<Dim>::start_flows(double rounder, std::int32_t begin, std::int32_t end) {
  for (std::int32_t i = begin; i < end; ++i) q(i)[0] = rounder, q(i)[1] = 0.0;
}

template <int Dim>
void ParticleStore<Dim>::take_out(double rounder, std::int32_t begin, std::int32_t end) {
  for (double *f = this->f(begin), *last = this->f(end); f != last; f += 4)
    for (int c = 0; c < 3; ++c) f[c] -= rounder;
}

template <int Dim>
void ParticleStore<Dim>::start_extra(std::int32_t begin, std::int32_t end) {
  extra_begin = begin;
  extra.assign(static_cast<std::size_t>(end - begin) * L::kForce, 0.0);
}

template <int Dim>
std::size_t ParticleStore<Dim>::bytes() const {
  std::size_t bytes = (force.capacity() + reference.capacity() + extra.capacity() +
                       heat_flow.capacity() + carried.capacity()) *
                      sizeof(double);
  for_each_array<Dim>([&](const auto& array) {
    const auto& values = this->*array.values;
    bytes += values.capacity() * sizeof(values[0]);
  });
  return bytes;
}

template struct ParticleStore<2>;
template struct ParticleStore<3>;

}  // namespace barchan
