#include <barchan/core/brick/messages.hpp>

#include <string>
#include <utility>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/world.hpp>

namespace barchan {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw RunError("a message between bricks is damaged: " + what);
}

bool is_below(std::int64_t number, std::size_t end) {
  return number >= 0 && static_cast<std::size_t>(number) < end;
}

template <int Dim>
std::int64_t id_of(const RowRecord<Dim>& p) {
  return *p.template values<&ParticleStore<Dim>::id>();
}

template <int Dim>
std::int64_t key_of(const RowRecord<Dim>& p) {
  return *p.template values<&ParticleStore<Dim>::key>();
}

/// Whether a particle is of this world, and in the cell that it claims.
template <int Dim>
void check(const RowRecord<Dim>& p, const World<Dim>& world) {
  using Store = ParticleStore<Dim>;
  constexpr int kAllFlags = Store::kFixed | Store::kBonded;
  const bool is_right = id_of(p) > 0 && p.is_valid() &&
                        *p.template values<&Store::type>() < world.laws.num_materials() &&
                        *p.template values<&Store::flags>() <= kAllFlags &&
                        key_of(p) == world.grid.key(p.template values<&Store::motion>());
  if (!is_right) refuse("particle " + std::to_string(id_of(p)) + " does not belong to this run");
}

template <int Dim>
void check_links(const Migration<Dim>& m, const World<Dim>& world) {
  const std::size_t n = m.particles.size();
  if (m.contacts.numbers.size() != m.contacts.size() * static_cast<std::size_t>(m.contacts.length))
    refuse("contacts with histories of another length");
  for (const auto& c : m.contacts.rows) {
    if (!is_below(c.handle, n)) refuse("a contact of a particle that is not in it");
  }
  for (const auto& w : m.walls) {
    if (!is_below(w.number, n) || !is_below(w.wall, world.walls.size()))
      refuse("a contact with a wall that does not exist, or of a particle that is not in it");
    for (const std::int32_t image : w.image) {
      if (image <= -kFarthestImage || image >= kFarthestImage)
        refuse("a contact with a wall that is too far away");
    }
  }
  for (const auto& b : m.bonds) {
    const bool is_right = b.bond.id_a > 0 && b.bond.id_a < b.bond.id_b &&
                          is_below(b.bond.law, world.bond_laws.size()) && b.is_current <= 1;
    if (!is_right) refuse("a bond that is not valid");
  }
}

}  // namespace

template <int Dim>
void encode(const Migration<Dim>& migration, std::vector<std::byte>& message) {
  message.clear();
  ByteWriter out(message);
  out.put_counted(migration.particles);
  out.put_counted(migration.contacts.rows);
  out.put_counted(migration.contacts.numbers);
  out.put_counted(migration.walls);
  out.put_counted(migration.bonds);
  if (!migration.carried.empty()) out.put_counted(migration.carried);
}

template <int Dim>
void encode_ghosts(const ParticleStore<Dim>& store, std::span<const Rows> runs,
                   std::vector<std::byte>& message) {
  std::vector<RowRecord<Dim>> records;
  for (const Rows rows : runs) {
    for (std::int32_t i = rows.begin; i < rows.end; ++i) {
      RowRecord<Dim>& record = records.emplace_back();
      record.take(store, i);
      record.forget_optional();
    }
  }
  message.clear();
  ByteWriter(message).put_counted(records);
}

template <int Dim>
Migration<Dim> decode_migration(std::span<const std::byte> message, const World<Dim>& world,
                                const CellBox<Dim>& box) {
  Migration<Dim> m;
  ByteReader in(message);
  m.particles = in.take_counted<RowRecord<Dim>>();
  m.contacts.length = world.history_form().length;
  m.contacts.rows = in.take_counted<LooseContact>();
  m.contacts.numbers = in.take_counted<double>();
  m.walls = in.take_counted<WallRecord<Dim>>();
  m.bonds = in.take_counted<BondRecord<Dim>>();
  if (world.num_carried > 0 && !m.particles.empty()) m.carried = in.take_counted<double>();
  in.finish();
  if (m.carried.size() != m.particles.size() * static_cast<std::size_t>(world.num_carried))
    refuse("particles that carry another number of numbers");
  for (const auto& p : m.particles) {
    check(p, world);
    if (!box.contains(cell_of_key(world.grid, key_of(p))))
      refuse("particle " + std::to_string(id_of(p)) + " belongs to another brick");
  }
  check_links(m, world);
  return m;
}

template <int Dim>
std::vector<RowRecord<Dim>> decode_ghosts(std::span<const std::byte> message,
                                          const World<Dim>& world, const CellRegion<Dim>& cells) {
  ByteReader in(message);
  auto ghosts = in.take_counted<RowRecord<Dim>>();
  in.finish();
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    check(ghosts[g], world);
    const bool is_next = g == 0 || key_of(ghosts[g - 1]) <= key_of(ghosts[g]);
    if (!is_next || !cells.contains(cell_of_key(world.grid, key_of(ghosts[g]))))
      refuse("ghosts out of order or of other cells");
  }
  return ghosts;
}

template void encode(const Migration<2>&, std::vector<std::byte>&);
template void encode(const Migration<3>&, std::vector<std::byte>&);
template void encode_ghosts(const ParticleStore<2>&, std::span<const Rows>,
                            std::vector<std::byte>&);
template void encode_ghosts(const ParticleStore<3>&, std::span<const Rows>,
                            std::vector<std::byte>&);
template Migration<2> decode_migration(std::span<const std::byte>, const World<2>&,
                                       const CellBox<2>&);
template Migration<3> decode_migration(std::span<const std::byte>, const World<3>&,
                                       const CellBox<3>&);
template std::vector<RowRecord<2>> decode_ghosts(std::span<const std::byte>, const World<2>&,
                                                 const CellRegion<2>&);
template std::vector<RowRecord<3>> decode_ghosts(std::span<const std::byte>, const World<3>&,
                                                 const CellRegion<3>&);

}  // namespace barchan
