#include <barchan/core/particles/row_order.hpp>

#include <algorithm>

#include <barchan/core/particles/row_record.hpp>

namespace barchan {
namespace {

template <int Dim>
void move_carried(ParticleStore<Dim>& store, const std::vector<std::int32_t>& source) {
  AlignedVector<double> moved;
  moved.reserve(source.size() * static_cast<std::size_t>(store.num_carried));
  for (const std::int32_t from : source) {
    const auto numbers = store.carried_by(from);
    moved.insert(moved.end(), numbers.begin(), numbers.end());
  }
  std::copy(moved.begin(), moved.end(), store.carried.begin());
}

}  // namespace

template <int Dim>
void move_rows(ParticleStore<Dim>& store, std::vector<std::int32_t>& source) {
  if (store.num_carried > 0) move_carried(store, source);
  RowRecord<Dim> first, moving;
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
