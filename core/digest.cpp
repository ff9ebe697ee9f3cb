#include <barchan/core/digest.hpp>

#include <xxhash.h>

#include <array>
#include <cstring>

namespace barchan {

std::uint64_t particle_digest(std::int64_t id, std::span<const double> position,
                              std::span<const double> velocity, std::span<const double> omega) {
  std::array<std::byte, 8 * 10> bytes{};
  std::size_t used = 0;
  const auto put = [&](const void* from, std::size_t count) {
    std::memcpy(bytes.data() + used, from, count);
    used += count;
  };
  put(&id, sizeof id);
  put(position.data(), position.size_bytes());
  put(velocity.data(), velocity.size_bytes());
  put(omega.data(), omega.size_bytes());
  return XXH3_64bits(bytes.data(), used);
}

}  // namespace barchan
