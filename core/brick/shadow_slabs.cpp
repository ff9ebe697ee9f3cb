#include <unordered_map>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/brick/cell_order.hpp>
#include <barchan/core/brick/rebuild.hpp>

namespace barchan {

template <int Dim>
void Rebuild<Dim>::begin_shadow(const Placement<Dim>& at) {
  own(at, 0);
  brick_.bonds = {};
  brick_.store.external.clear();
}

template <int Dim>
void Rebuild<Dim>::pack_slabs(int link, int depth, std::vector<std::byte>& message) const {
  const Side side = brick_.links[static_cast<std::size_t>(link)].side;
  std::vector<Rows> slabs;
  std::vector<Migration<Dim>> out(static_cast<std::size_t>(depth));
  std::unordered_map<std::int64_t, std::size_t> slab_of;  // of bonded particles
  for (std::size_t n = 0; n < out.size(); ++n) {
    const Rows rows = slabs.emplace_back(slab_behind(brick_, side, static_cast<int>(n)));
    out[n].contacts.length = brick_.world->history_form().length;
    for (std::int32_t i = rows.begin; i < rows.end; ++i) {
      out[n].particles.emplace_back().take(brick_.store, i);
      if ((brick_.store.flags[static_cast<std::size_t>(i)] & ParticleStore<Dim>::kBonded) != 0)
        slab_of[brick_.store.id[static_cast<std::size_t>(i)]] = n;
    }
  }
  carry_.copy(new_row_, slabs, out);
  for (const Bond<Dim>& bond : brick_.bonds.bonds()) {
    const auto a = slab_of.find(bond.id_a), z = slab_of.find(bond.id_b);
    if (a != slab_of.end()) out[a->second].bonds.push_back({bond, 1});
    if (z != slab_of.end() && (a == slab_of.end() || z->second != a->second))
      out[z->second].bonds.push_back({bond, 1});
  }
  message.clear();
  ByteWriter writer(message);
  std::vector<std::byte> slab;
  for (const Migration<Dim>& each : out) {
    encode(each, slab);
    writer.put_counted(slab);
  }
  const Rows behind = slab_behind(brick_, side, depth);
  encode_ghosts<Dim>(brick_.store, std::span(&behind, 1), slab);
  writer.put_counted(slab);
}

std::vector<std::vector<std::byte>> unpack_slabs(ByteReader& in, int depth) {
  std::vector<std::vector<std::byte>> slabs;
  for (int n = 0; n <= depth; ++n) slabs.push_back(in.take_counted<std::byte>());
  return slabs;
}

template void Rebuild<2>::begin_shadow(const Placement<2>&);
template void Rebuild<3>::begin_shadow(const Placement<3>&);
template void Rebuild<2>::pack_slabs(int, int, std::vector<std::byte>&) const;
template void Rebuild<3>::pack_slabs(int, int, std::vector<std::byte>&) const;

}  // namespace barchan
