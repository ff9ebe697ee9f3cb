#include <barchan/core/contact_search.hpp>

#include <cmath>

namespace barchan {

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
template <bool Periodic>
void ContactSearch<Dim>::row(std::int32_t i, Rows partners, PairList& list) const {
  using Store = ParticleStore<Dim>;
  const PeriodicBox& box = grid_.box();
  const double* a = store_.x(i);
  const double reach_i = store_.radius(i) + rule_.skin;
  const bool fixed = (store_.flags[static_cast<std::size_t>(i)] & Store::kFixed) != 0;
  for (std::int32_t j = partners.begin; j < partners.end; ++j) {
    const double* b = store_.x(j);
    double d2 = 0.0;
    for (int c = 0; c < Dim; ++c) {
      double d = b[c] - a[c];
      if constexpr (Periodic) d -= box.length[c] * std::rint(d * box.inverse[c]);
      d2 += d * d;
    }
    const double reach = reach_i + store_.radius(j);
    if (d2 >= reach * reach) continue;
    if (fixed && (store_.flags[static_cast<std::size_t>(j)] & Store::kFixed) != 0) continue;
    list.push(i, j, law(i, j));
  }
}

template <int Dim>
void ContactSearch<Dim>::scan(std::int32_t i, Rows partners, PairList& list) const {
  grid_.box().any() ? row<true>(i, partners, list) : row<false>(i, partners, list);
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
    scan(i, {i + 1, cells.cells(key, key + 1).end}, list);
    for (int q = 0; q < around.count; ++q)
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

template class ContactSearch<2>;
template class ContactSearch<3>;

}  // namespace barchan
