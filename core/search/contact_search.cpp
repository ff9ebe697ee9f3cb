#include <barchan/core/search/contact_search.hpp>

#include <algorithm>
#include <array>

namespace barchan {

template <int Dim>
void Planes::write(const Grid<Dim>& grid, const ParticleStore<Dim>& store, Rows rows) {
  first = rows.begin;
  const auto n = static_cast<std::size_t>(rows.end - rows.begin);
  for (int c = 0; c < Dim; ++c) resize_with_room(axis[c], n + kBatch);
  resize_with_room(radius, n + kBatch);
  for (std::size_t q = 0; q < n; ++q) {
    const auto row = first + static_cast<std::int32_t>(q);
    double x[Dim];
    std::copy_n(store.x(row), Dim, x);
    grid.wrap(x);
    for (int c = 0; c < Dim; ++c) axis[c][q] = x[c];
    radius[q] = store.radius(row);
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

/// Appends the partners of row i that are within reach. Pairs of the list beyond `size` are any.
template <int Dim>
void ContactSearch<Dim>::scan(SearchJob& job, std::int32_t i, std::span<const Rows> partners,
                              PairList& list, std::int64_t& size) const {
  std::copy_n(store_.x(i), Dim, job.at);
  grid_.wrap(job.at);
  job.reach = store_.radius(i) + rule_.beyond;
  std::int64_t most = size + kBatch;
  for (const Rows rows : partners) most += rows.end - rows.begin;
  list.make_room(most);
  std::int64_t end = size + rule_.kernel(job, partners.data(), static_cast<int>(partners.size()),
                                         list.j.data() + size);
  if ((store_.flags[static_cast<std::size_t>(i)] & ParticleStore<Dim>::kFixed) != 0)
    end = leave_fixed_out(list, size, end);
  std::fill(list.i.begin() + size, list.i.begin() + end, i);
  set_laws(i, list, size, end);
  size = end;
}

template <int Dim>
std::int64_t ContactSearch<Dim>::leave_fixed_out(PairList& list, std::int64_t begin,
                                                 std::int64_t end) const {
  const auto is_fixed = [this](std::int32_t j) {
    return (store_.flags[static_cast<std::size_t>(j)] & ParticleStore<Dim>::kFixed) != 0;
  };
  return std::remove_if(list.j.begin() + begin, list.j.begin() + end, is_fixed) - list.j.begin();
}

template <int Dim>
void ContactSearch<Dim>::set_laws(std::int32_t i, PairList& list, std::int64_t begin,
                                  std::int64_t end) const {
  const auto a = static_cast<std::size_t>(i);
  const int type = store_.type[a];
  const bool has_bond = (store_.flags[a] & ParticleStore<Dim>::kBonded) != 0;
  if (!has_bond && rule_.laws->num_materials() == 1) {
    std::fill(list.code.begin() + begin, list.code.begin() + end, rule_.laws->code(type, type));
    return;
  }
  for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
    const auto b = static_cast<std::size_t>(list.j[k]);
    const bool is_bonded = has_bond && (store_.flags[b] & ParticleStore<Dim>::kBonded) != 0 &&
                           rule_.bonded->contains(store_.id[a], store_.id[b]);
    list.code[k] = is_bonded ? LawTable::kBonded : rule_.laws->code(type, store_.type[b]);
  }
}

template <int Dim>
void ContactSearch<Dim>::owned(const CellIndex<Dim>& cells, PairList& list,
                               std::vector<std::int64_t>& row_begin) const {
  const bool all_pairs = rule_.kind == ContactSearchKind::AllPairs;
  const std::int32_t n = store_.num_owned;
  std::int64_t last_key = -1, size = list.size();
  Neighbourhood<Dim> around;
  around.count = 1;
  around.ranges[0].end = n;
  SearchJob job = job_;
  job.wraps = grid_.box().any();
  for (std::int32_t i = 0; i < n; ++i) {
    row_begin[static_cast<std::size_t>(i)] = size;
    const std::int64_t key = store_.key[static_cast<std::size_t>(i)];
    if (!all_pairs && key != last_key) {
      around.collect(cells, cell_of_key(grid_, key), {i, n});
      job.wraps = around.wraps;
      last_key = key;
    }
    around.ranges[0].begin = i + 1;  // its own cell's rows are the lowest of them
    scan(job, i, std::span(around.ranges.data(), static_cast<std::size_t>(around.count)), list,
         size);
  }
  list.shorten(size);
}

template <int Dim>
void ContactSearch<Dim>::across(const CellIndex<Dim>& cells, Rows own, Rows ghosts,
                                PairList& list) const {
  const bool all_pairs = rule_.kind == ContactSearchKind::AllPairs;
  std::int64_t last_key = -1, size = list.size();
  Neighbourhood<Dim> around;
  around.count = 1;
  around.ranges[0] = ghosts;
  SearchJob job = job_;
  job.wraps = grid_.box().any();
  for (std::int32_t i = own.begin; i < own.end; ++i) {
    const std::int64_t key = store_.key[static_cast<std::size_t>(i)];
    if (!all_pairs && key != last_key) {
      around.collect(cells, cell_of_key(grid_, key), ghosts);
      job.wraps = around.wraps;
      last_key = key;
    }
    if (around.count == 0) continue;
    scan(job, i, std::span(around.ranges.data(), static_cast<std::size_t>(around.count)), list,
         size);
  }
  list.shorten(size);
}

template void Planes::write(const Grid<2>&, const ParticleStore<2>&, Rows);
template void Planes::write(const Grid<3>&, const ParticleStore<3>&, Rows);
template class ContactSearch<2>;
template class ContactSearch<3>;

}  // namespace barchan
