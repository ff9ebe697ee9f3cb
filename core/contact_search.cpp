#include <barchan/core/contact_search.hpp>

#include <algorithm>
#include <array>

namespace barchan {

template <int Dim>
void Planes::write(const ParticleStore<Dim>& store, Rows rows) {
  first = rows.begin;
  const auto n = static_cast<std::size_t>(rows.end - rows.begin);
  for (int c = 0; c < Dim; ++c) resize_with_room(axis[c], n + kBatch);
  resize_with_room(radius, n + kBatch);
  for (std::size_t q = 0; q < n; ++q) {
    const double* x = store.x(first + static_cast<std::int32_t>(q));
    for (int c = 0; c < Dim; ++c) axis[c][q] = x[c];
    radius[q] = x[Layout<Dim>::kRadius];
  }
}

std::size_t Planes::bytes() const {
  std::size_t total = radius.capacity();
  for (const auto& a : axis) total += a.capacity();
  return 8 * total;
}

template <int Dim>
ContactSearch<Dim>::ContactSearch(const Grid<Dim>& grid, const ParticleStore<Dim>& store,
                                  const Planes& planes, const SearchRule& rule)
    : grid_(grid), store_(store), rule_(rule) {
  for (int c = 0; c < Dim; ++c) job_.x[c] = planes.axis[c].data();
  job_.radius = planes.radius.data();
  job_.first = planes.first;
  job_.box = grid.box();
}

template <int Dim>
std::uint8_t ContactSearch<Dim>::law(std::int32_t i, std::int32_t j) const {
  using Store = ParticleStore<Dim>;
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  if ((store_.flags[a] & store_.flags[b] & Store::kBonded) != 0 &&
      rule_.bonded->contains(store_.id[a], store_.id[b])) {
    return LawTable::kBonded;
  }
  return rule_.laws->code(store_.type[a], store_.type[b]);
}

template <int Dim>
void ContactSearch<Dim>::scan(std::int32_t i, Rows partners, PairList& list) const {
  using Store = ParticleStore<Dim>;
  constexpr std::int32_t kSlice = 1024;
  SearchJob job = job_;
  std::copy_n(store_.x(i), Dim, job.at);
  job.reach = store_.radius(i) + rule_.skin;
  const bool fixed = (store_.flags[static_cast<std::size_t>(i)] & Store::kFixed) != 0;
  std::array<std::int32_t, kSlice + kBatch> found;
  for (std::int32_t begin = partners.begin; begin < partners.end; begin += kSlice) {
    const std::int32_t end = std::min(partners.end, begin + kSlice);
    const int count = rule_.kernel(job, begin, end, found.data());
    for (int q = 0; q < count; ++q) {
      const std::int32_t j = found[static_cast<std::size_t>(q)];
      if (fixed && (store_.flags[static_cast<std::size_t>(j)] & Store::kFixed) != 0) continue;
      list.push(i, j, law(i, j));
    }
  }
}

template <int Dim>
void ContactSearch<Dim>::owned(const CellIndex& cells, Rows rows, PairList& list,
                               std::vector<std::int64_t>& row_begin) const {
  std::int64_t last_key = -1;
  Neighbourhood<Dim> around;
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    row_begin[static_cast<std::size_t>(i)] = list.size();
    if (rule_.kind == ContactSearchKind::AllPairs) {
      scan(i, {i + 1, store_.num_owned}, list);
      continue;
    }
    const std::int64_t key = store_.key[static_cast<std::size_t>(i)];
    if (key != last_key) {
      around.collect(grid_, cells, key, grid_.is_periodic(0) ? -1 : 0, 1, key);
      last_key = key;
    }
    // The cells that follow this one along its line lie behind it in storage too.
    Rows behind{i + 1, cells.cells(key, key + 1).end};
    const bool joined = around.count > 0 && around.ranges[0].begin == behind.end;
    if (joined) behind.end = around.ranges[0].end;
    scan(i, behind, list);
    for (int q = joined ? 1 : 0; q < around.count; ++q)
      scan(i, around.ranges[static_cast<std::size_t>(q)], list);
  }
}

template <int Dim>
void ContactSearch<Dim>::across(const CellIndex& lower, const CellIndex& higher,
                                int lower_to_higher, PairList& list) const {
  const std::int32_t begin = lower.start.front(), end = lower.start.back();
  const Rows all{higher.start.front(), higher.start.back()};
  Neighbourhood<Dim> around;
  for (std::int32_t i = begin; i < end; ++i) {
    if (rule_.kind == ContactSearchKind::AllPairs) {
      scan(i, all, list);
      continue;
    }
    around.collect(grid_, higher, store_.key[static_cast<std::size_t>(i)], lower_to_higher,
                   lower_to_higher, -1);
    for (int q = 0; q < around.count; ++q)
      scan(i, around.ranges[static_cast<std::size_t>(q)], list);
  }
}

template void Planes::write(const ParticleStore<2>&, Rows);
template void Planes::write(const ParticleStore<3>&, Rows);
template class ContactSearch<2>;
template class ContactSearch<3>;

}  // namespace barchan
