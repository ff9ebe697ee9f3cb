#include <barchan/core/model/digest.hpp>

#include <xxhash.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include <barchan/core/base/bytes.hpp>

namespace barchan {

std::uint64_t particle_digest(std::int64_t id, std::span<const double> position,
                              std::span<const double> velocity, std::span<const double> omega,
                              std::span<const double> temperature) {
  std::array<std::byte, 8 * 12> bytes{};
  std::size_t used = 0;
  const auto put = [&](const void* from, std::size_t count) {
    if (count == 0) return;  // of nothing there may be no address
    std::memcpy(bytes.data() + used, from, count);
    used += count;
  };
  put(&id, sizeof id);
  put(position.data(), position.size_bytes());
  put(velocity.data(), velocity.size_bytes());
  put(omega.data(), omega.size_bytes());
  put(temperature.data(), temperature.size_bytes());
  return XXH3_64bits(bytes.data(), used);
}

std::uint64_t hash_of_bytes(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint64_t particle_set_hash(const ParticleSet& set) {
  // One hash feeds the next, so that order counts and padding does not.
  std::uint64_t hash = set.particles.size();
  std::vector<std::byte> bytes;
  const auto take = [&] {
    hash = XXH3_64bits_withSeed(bytes.data(), bytes.size(), hash);
    bytes.clear();
  };
  ByteWriter out(bytes);
  for (const ParticleData& p : set.particles) {
    out.put(p.id);
    out.put(p.type);
    out.put(p.fixed);
    for (const double value : {p.radius, p.density}) out.put(value);
    for (const Vec3* v : {&p.position, &p.velocity, &p.omega})
      out.put_all(std::span<const double>(v->data(), 3));
    if (!std::isnan(p.temperature)) out.put(p.temperature);
    take();
  }
  for (const BondData& b : set.bonds) {
    out.put(b.id_a);
    out.put(b.id_b);
    out.put(b.law);
    for (const double value : {b.length, b.twisting}) out.put(value);
    for (const Vec3* v : {&b.shear, &b.bending}) out.put_all(std::span<const double>(v->data(), 3));
    take();
  }
  return hash;
}

}  // namespace barchan
