#include <barchan/core/particle_store.hpp>

#include <algorithm>

namespace barchan {

template <int Dim>
void ParticleStore<Dim>::resize_for_ghosts() {
  const auto n = static_cast<std::size_t>(size());
  resize_with_room(motion, n * L::kMotion);
  resize_with_room(spin, n * L::kSpin);
  resize_with_room(force, n * L::kForce);
  std::fill(force.begin(), force.end(), 0.0);
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
std::size_t ParticleStore<Dim>::bytes() const {
  return 8 * (motion.capacity() + spin.capacity() + force.capacity() + reference.capacity() +
              id.capacity() + key.capacity() + external.capacity()) +
         type.capacity() + flags.capacity();
}

template struct ParticleStore<2>;
template struct ParticleStore<3>;

}  // namespace barchan
