#include <barchan/core/particle_store.hpp>

#include <algorithm>

namespace barchan {

template <int Dim>
void ParticleStore<Dim>::resize_for_ghosts(double rounder) {
  const auto n = static_cast<std::size_t>(size());
  resize_with_room(motion, n * L::kMotion);
  resize_with_room(spin, n * L::kSpin);
  resize_with_room(force, n * L::kForce);
  start_forces(rounder, 0, size());
  resize_with_room(id, n);
  resize_with_room(key, n);
  resize_with_room(type, n);
  resize_with_room(flags, n);
  for (std::int32_t w = waste(); w < waste() + 2; ++w) {
    std::fill_n(x(w), int{L::kMotion}, 0.0);
    std::fill_n(u(w), Dim == 2 ? 1 : 4, 0.0);
    x(w)[0] = -1e9 * (1 + w - waste());
    x(w)[L::kInverseMass] = 1.0;
    const auto at = static_cast<std::size_t>(w);
    id[at] = -1;
    key[at] = -1;
    type[at] = flags[at] = 0;
  }
}

template <int Dim>
void ParticleStore<Dim>::start_forces(double rounder, std::int32_t begin, std::int32_t end) {
  for (double *f = this->f(begin), *last = this->f(end); f != last; f += 4)
    f[0] = f[1] = f[2] = rounder, f[3] = 0.0;
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
  return 8 * (motion.capacity() + spin.capacity() + force.capacity() + reference.capacity() +
              id.capacity() + key.capacity() + external.capacity() + extra.capacity()) +
         type.capacity() + flags.capacity();
}

template struct ParticleStore<2>;
template struct ParticleStore<3>;

}  // namespace barchan
