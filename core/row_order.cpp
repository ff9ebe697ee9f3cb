#include <barchan/core/row_order.hpp>

#include <algorithm>
#include <array>

namespace barchan {
namespace {

/// All that the store has of one row.
template <int Dim>
struct Row {
  using L = Layout<Dim>;
  std::array<double, L::kMotion> motion;
  std::array<double, L::kSpin> spin;
  std::array<double, L::kForce> external;
  std::int64_t id, key;
  std::uint8_t type, flags;

  void take(const ParticleStore<Dim>& s, std::int32_t row) {
    const auto at = static_cast<std::size_t>(row);
    std::copy_n(s.x(row), int{L::kMotion}, motion.data());
    if constexpr (Dim == 3) std::copy_n(s.u(row), int{L::kSpin}, spin.data());
    if (!s.external.empty())
      std::copy_n(s.external.data() + at * L::kForce, int{L::kForce}, external.data());
    id = s.id[at];
    key = s.key[at];
    type = s.type[at];
    flags = s.flags[at];
  }

  void put(ParticleStore<Dim>& s, std::int32_t row) const {
    const auto at = static_cast<std::size_t>(row);
    std::copy_n(motion.data(), int{L::kMotion}, s.x(row));
    if constexpr (Dim == 3) std::copy_n(spin.data(), int{L::kSpin}, s.u(row));
    if (!s.external.empty())
      std::copy_n(external.data(), int{L::kForce}, s.external.data() + at * L::kForce);
    s.id[at] = id;
    s.key[at] = key;
    s.type[at] = type;
    s.flags[at] = flags;
  }
};

}  // namespace

template <int Dim>
void move_rows(ParticleStore<Dim>& store, std::vector<std::int32_t>& source) {
  Row<Dim> first, moving;
  for (std::int32_t start = 0; start < static_cast<std::int32_t>(source.size()); ++start) {
    if (source[static_cast<std::size_t>(start)] == start) continue;
    first.take(store, start);
    std::int32_t to = start;
    while (true) {
      std::int32_t& from = source[static_cast<std::size_t>(to)];
      const std::int32_t next = from;
      from = to;
      if (next == start) break;
      moving.take(store, next);
      moving.put(store, to);
      to = next;
    }
    first.put(store, to);
  }
}

template void move_rows(ParticleStore<2>&, std::vector<std::int32_t>&);
template void move_rows(ParticleStore<3>&, std::vector<std::int32_t>&);

}  // namespace barchan
