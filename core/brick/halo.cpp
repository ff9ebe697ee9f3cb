#include <barchan/core/brick/halo.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <barchan/core/base/error.hpp>
#include <barchan/core/particles/fields.hpp>

namespace barchan {
namespace {

/// Calls f(bytes of a field of a row, how many) for what a halo has of it.
template <int Dim, class Store, class F>
void for_each_halo_field(Store& store, std::int32_t row, F&& f) {
  for_each_field<Dim>([&]<class T>(const Field<Dim, T>& field) {
    if (field.is_in_halo && field.array.is_in(store))
      f(field.of(store, row), static_cast<std::size_t>(field.width) * sizeof(T));
  });
}

}  // namespace

template <int Dim>
std::size_t halo_bytes(const Brick<Dim>& brick, Rows rows) {
  return static_cast<std::size_t>(rows.end - rows.begin) *
         halo_record_bytes<Dim>(brick.world->heat.is_on);
}

template <int Dim>
std::size_t halo_bytes(const Brick<Dim>& brick, int link) {
  return static_cast<std::size_t>(brick.links[static_cast<std::size_t>(link)].num_sent) *
         halo_record_bytes<Dim>(brick.world->heat.is_on);
}

template <int Dim>
void pack_halo(const Brick<Dim>& brick, Rows rows, std::span<std::byte> message) {
  std::byte* to = message.data();
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    for_each_halo_field<Dim>(brick.store, i, [&](const void* from, std::size_t bytes) {
      std::memcpy(to, from, bytes);
      to += bytes;
    });
  }
}

template <int Dim>
void pack_halo(const Brick<Dim>& brick, int link, std::span<std::byte> message) {
  for (const Rows rows : brick.links[static_cast<std::size_t>(link)].runs) {
    pack_halo(brick, rows, message);
    message = message.subspan(halo_bytes(brick, rows));
  }
}

template <int Dim>
void unpack_halo(Brick<Dim>& brick, int link, std::span<const std::byte> message) {
  ParticleStore<Dim>& store = brick.store;
  BrickLink<Dim>& mine = brick.links[static_cast<std::size_t>(link)];
  const std::int32_t n = mine.ghosts.end - mine.ghosts.begin;
  if (message.size() != static_cast<std::size_t>(n) * halo_record_bytes<Dim>(store.has_heat)) {
    throw RunError("a halo message has " + std::to_string(message.size()) + " bytes for " +
                   std::to_string(n) + " ghosts");
  }
  const std::byte* from = message.data();
  double top2 = 0.0;
  for (std::int32_t g = mine.ghosts.begin; g < mine.ghosts.end; ++g) {
    for_each_halo_field<Dim>(store, g, [&](void* to, std::size_t bytes) {
      std::memcpy(to, from, bytes);
      from += bytes;
    });
    const double* v = store.v(g);
    top2 = std::max(top2, v[0] * v[0] + v[1] * v[1] + (Dim == 3 ? v[2] * v[2] : 0.0));
  }
  const double travel = std::sqrt(top2) * brick.world->last_dt;
  mine.travel += travel;
  mine.has_quick = travel > brick.world->quick_travel;
  Band& band = brick.band(mine.side);
  band.travel = std::max(band.travel, mine.travel);
  band.has_quick = std::ranges::any_of(brick.links, [&](const BrickLink<Dim>& other) {
    return other.side == mine.side && other.has_quick;
  });
}

template <int Dim>
std::size_t results_bytes(const Brick<Dim>& brick, Side side) {
  const auto group = side == Side::Left ? BondSet<Dim>::Left : BondSet<Dim>::Right;
  const Rows rows =
      side == Side::Left ? brick.store.ghosts(Side::Left) : brick.band(Side::Right).rows;
  const std::size_t record = Layout<Dim>::kForce + (brick.store.has_heat ? 2 : 0);
  return (static_cast<std::size_t>(rows.end - rows.begin) * record +
          static_cast<std::size_t>(brick.bonds.size(group)) * BondSet<Dim>::kExported) *
         sizeof(double);
}

template <int Dim>
void take_results(Brick<Dim>& brick, std::vector<double>& out) {
  ParticleStore<Dim>& store = brick.store;
  const Rows ghosts = store.ghosts(Side::Left);
  const double rounder = brick.world->grain.rounder();
  store.take_out(rounder, ghosts.begin, ghosts.end);
  out.assign(store.f(ghosts.begin), store.f(ghosts.end));
  store.start_forces(rounder, ghosts.begin, ghosts.end);
  if (store.has_heat) {
    const double start = brick.world->heat.grain.rounder();
    for (std::int32_t i = ghosts.begin; i < ghosts.end; ++i)
      out.insert(out.end(), {store.q(i)[0] - start, store.q(i)[1]});
    store.start_flows(start, ghosts.begin, ghosts.end);
  }
  brick.bonds.export_group(BondSet<Dim>::Left, out);
}

template <int Dim>
void add_results(Brick<Dim>& brick, std::span<const double> results) {
  const Rows rows = brick.band(Side::Right).rows;
  if (results.size() * sizeof(double) != results_bytes(brick, Side::Right)) {
    throw RunError("a results message has " + std::to_string(results.size()) + " numbers for " +
                   std::to_string(rows.end - rows.begin) + " particles and " +
                   std::to_string(brick.bonds.size(BondSet<Dim>::Right)) + " bonds");
  }
  const double* f = results.data();
  for (std::int32_t i = rows.begin; i < rows.end; ++i) {
    double* row = brick.store.f(i);
    for (int c = 0; c < Layout<Dim>::kForce; ++c) row[c] += *f++;
  }
  for (std::int32_t i = rows.begin; brick.store.has_heat && i < rows.end; ++i) {
    for (int c = 0; c < 2; ++c) brick.store.q(i)[c] += *f++;
  }
  brick.bonds.import_group(BondSet<Dim>::Right, brick.store, f);
}

template std::size_t halo_bytes(const Brick<2>&, Rows);
template std::size_t halo_bytes(const Brick<3>&, Rows);
template void pack_halo(const Brick<2>&, Rows, std::span<std::byte>);
template void pack_halo(const Brick<3>&, Rows, std::span<std::byte>);
template std::size_t halo_bytes(const Brick<2>&, int);
template std::size_t halo_bytes(const Brick<3>&, int);
template void pack_halo(const Brick<2>&, int, std::span<std::byte>);
template void pack_halo(const Brick<3>&, int, std::span<std::byte>);
template void unpack_halo(Brick<2>&, int, std::span<const std::byte>);
template void unpack_halo(Brick<3>&, int, std::span<const std::byte>);
template std::size_t results_bytes(const Brick<2>&, Side);
template std::size_t results_bytes(const Brick<3>&, Side);
template void take_results(Brick<2>&, std::vector<double>&);
template void take_results(Brick<3>&, std::vector<double>&);
template void add_results(Brick<2>&, std::span<const double>);
template void add_results(Brick<3>&, std::span<const double>);

}  // namespace barchan
