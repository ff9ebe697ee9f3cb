#include <barchan/core/links/bonds.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <unordered_map>

#include <barchan/core/base/error.hpp>

namespace barchan {

template <int Dim>
BondSection bond_section(const BondLaw& law, double length, double radius_a, double radius_b) {
  BondSection s{};
  const double r = s.radius = law.radius_factor * std::min(radius_a, radius_b);
  if constexpr (Dim == 2) {
    s.area = 2.0 * r;
    s.inertia = 2.0 / 3.0 * r * r * r;
  } else {
    s.area = std::numbers::pi * r * r;
    s.inertia = 0.25 * s.area * r * r;
    s.polar = 2.0 * s.inertia;
  }
  const double normal =
      law.normal_stiffness > 0.0 ? law.normal_stiffness : law.young_modulus / length;
  const double shear = normal / law.stiffness_ratio;
  s.kn = normal * s.area;
  s.ks = shear * s.area;
  s.bending = normal * s.inertia;
  s.twisting = shear * s.polar;
  return s;
}

template <int Dim>
Bond<Dim> bond_of(const BondData& data, double at_start) {
  const double length = data.length > 0.0 ? data.length : at_start;
  const Vec3 &s = data.shear, &m = data.bending;
  if constexpr (Dim == 2)
    return {data.id_a, data.id_b, data.law, length, {s[0], m[2]}};
  else
    return {data.id_a,
            data.id_b,
            data.law,
            length,
            {s[0], s[1], s[2], m[0], m[1], m[2], data.twisting}};
}

template <int Dim>
BondData data_of(const Bond<Dim>& bond) {
  BondData data{bond.id_a, bond.id_b, bond.law, bond.length};
  const auto& state = bond.state;
  if constexpr (Dim == 2) {
    data.shear[0] = state[0];
    data.bending[2] = state[1];
  } else {
    data.shear = Vec3(state[0], state[1], state[2]);
    data.bending = Vec3(state[3], state[4], state[5]);
    data.twisting = state[6];
  }
  return data;
}

template <int Dim>
void BondSet<Dim>::add(const Bond<Dim>& bond, bool is_current) {
  const auto [it, is_new] = known_.try_emplace({bond.id_a, bond.id_b}, bonds_.size());
  if (is_new) {
    bonds_.push_back(bond);
    broken_.push_back(0);
  } else if (is_current) {
    bonds_[it->second] = bond;
  }
}

template <int Dim>
void BondSet<Dim>::resolve(ParticleStore<Dim>& store) {
  using Store = ParticleStore<Dim>;
  incidences_.clear();
  group_begin_ = {};
  if (bonds_.empty()) return;
  std::unordered_map<std::int64_t, std::int32_t> where;
  for (std::int32_t i = 0; i < store.size(); ++i) {
    if ((store.flags[static_cast<std::size_t>(i)] & Store::kBonded) != 0)
      where[store.id[static_cast<std::size_t>(i)]] = i;
  }
  const auto find = [&](std::int64_t id) {
    const auto it = where.find(id);
    return it == where.end() ? std::int32_t{-1} : it->second;
  };
  std::erase_if(bonds_, [&](const Bond<Dim>& b) {
    const std::int32_t i = find(b.id_a), j = find(b.id_b);
    return (i < 0 || !store.is_owned(i)) && (j < 0 || !store.is_owned(j));
  });
  const auto group = [&](const Bond<Dim>& b) {
    const std::int32_t last = std::max(find(b.id_a), find(b.id_b));
    if (store.is_owned(last)) return Owned;
    return last < store.ghost_begin(Side::Right) ? Left : Right;
  };
  std::sort(bonds_.begin(), bonds_.end(), [&](const Bond<Dim>& p, const Bond<Dim>& q) {
    return std::tuple(group(p), p.id_a, p.id_b) < std::tuple(group(q), q.id_a, q.id_b);
  });
  ends_.clear();
  for (const Bond<Dim>& b : bonds_) {
    const std::int32_t i = find(b.id_a), j = find(b.id_b);
    if (i < 0 || j < 0) {
      throw RunError(
          "the bond between particles " + std::to_string(b.id_a) + " and " +
          std::to_string(b.id_b) +
          " has grown longer than a cell is wide: give it a tensile strength, or a larger "
          "search.skin");
    }
    const auto index = static_cast<std::int32_t>(ends_.size());
    ends_.emplace_back(i, j);
    for (int g = group(b) + 1; g <= kNumGroups; ++g) ++group_begin_[static_cast<std::size_t>(g)];
    if (store.is_owned(i)) incidences_.push_back({i, j, index, false});
    if (store.is_owned(j)) incidences_.push_back({j, i, index, true});
  }
  std::sort(incidences_.begin(), incidences_.end(), [&](const Incidence& p, const Incidence& q) {
    const auto id = [&](const Incidence& i) {
      return store.id[static_cast<std::size_t>(i.partner)];
    };
    return p.row != q.row ? p.row < q.row : id(p) < id(q);
  });
  force_.assign(bonds_.size(), {});
  broken_.assign(bonds_.size(), 0);
  index_known();
}

template <int Dim>
std::span<const std::int32_t> BondSet<Dim>::compute(Group group, const ParticleStore<Dim>& store,
                                                    std::span<const BondLaw> laws,
                                                    const PeriodicBox& box, double dt) {
  just_broken_.clear();
  const auto g = static_cast<std::size_t>(group);
  for (std::int32_t b = group_begin_[g]; b < group_begin_[g + 1]; ++b) {
    if (is_broken(b)) continue;
    const auto& bond = bonds_[static_cast<std::size_t>(b)];
    if (respond(b, store, laws[static_cast<std::size_t>(bond.law)], box, dt)) continue;
    broken_[static_cast<std::size_t>(b)] = 1;
    force_[static_cast<std::size_t>(b)] = {};
    if (store.is_owned(end_a(b))) count_break(b);
    just_broken_.push_back(b);
  }
  return just_broken_;
}

template <int Dim>
void BondSet<Dim>::count_break(std::int32_t bond) {
  ++num_broken_;
  const Bond<Dim>& its = bonds_[static_cast<std::size_t>(bond)];
  if (keeps_breaks_) breaks_.push_back({step_, its.id_a, its.id_b});
}

template <int Dim>
void BondSet<Dim>::add_to_rows(ParticleStore<Dim>& store, std::int32_t begin,
                               std::int32_t end) const {
  auto it = std::lower_bound(incidences_.begin(), incidences_.end(), begin,
                             [](const Incidence& p, std::int32_t row) { return p.row < row; });
  for (; it != incidences_.end() && it->row < end; ++it) {
    if (is_broken(it->bond)) continue;
    const Record& record = force_[static_cast<std::size_t>(it->bond)][it->is_b ? 1 : 0];
    double* f = store.e(it->row);
    for (std::size_t c = 0; c < record.size(); ++c) f[c] += record[c];
  }
}

template <int Dim>
void BondSet<Dim>::export_group(Group group, std::vector<double>& out) const {
  const auto g = static_cast<std::size_t>(group);
  for (std::int32_t b = group_begin_[g]; b < group_begin_[g + 1]; ++b) {
    for (const Record& record : force_[static_cast<std::size_t>(b)])
      out.insert(out.end(), record.begin(), record.end());
    out.push_back(is_broken(b) ? 1.0 : 0.0);
  }
}

template <int Dim>
void BondSet<Dim>::import_group(Group group, const ParticleStore<Dim>& store, const double* in) {
  const auto g = static_cast<std::size_t>(group);
  for (std::int32_t b = group_begin_[g]; b < group_begin_[g + 1]; ++b) {
    for (Record& record : force_[static_cast<std::size_t>(b)]) {
      std::copy_n(in, record.size(), record.begin());
      in += record.size();
    }
    const bool broke = *in++ != 0.0;
    if (broke && !is_broken(b) && store.is_owned(end_a(b))) count_break(b);
    broken_[static_cast<std::size_t>(b)] = broke ? 1 : 0;
  }
}

template <int Dim>
void BondSet<Dim>::drop_broken() {
  std::size_t kept = 0;
  for (std::size_t b = 0; b < broken_.size(); ++b) {
    if (broken_[b] == 0) bonds_[kept++] = bonds_[b];
  }
  bonds_.resize(kept);
  broken_.assign(kept, 0);
  index_known();
}

template <int Dim>
void BondSet<Dim>::index_known() {
  known_.clear();
  for (std::size_t b = 0; b < bonds_.size(); ++b) known_[{bonds_[b].id_a, bonds_[b].id_b}] = b;
}

template <int Dim>
std::size_t BondSet<Dim>::bytes() const {
  return bonds_.capacity() * sizeof(Bond<Dim>) + ends_.capacity() * sizeof(ends_[0]) +
         broken_.capacity() + incidences_.capacity() * sizeof(Incidence) +
         force_.capacity() * sizeof(force_[0]);
}

template BondSection bond_section<2>(const BondLaw&, double, double, double);
template BondSection bond_section<3>(const BondLaw&, double, double, double);
template Bond<2> bond_of(const BondData&, double);
template Bond<3> bond_of(const BondData&, double);
template BondData data_of(const Bond<2>&);
template BondData data_of(const Bond<3>&);
template <int Dim>
void BondSet<Dim>::require_short(const Grid<Dim>& grid, const ParticleStore<Dim>& store) const {
  const auto cell = [&](std::int32_t row) {
    return cell_of_key(grid, store.key[static_cast<std::size_t>(row)]);
  };
  for (std::int32_t b = 0; b < static_cast<std::int32_t>(bonds_.size()); ++b) {
    const CellAt<Dim> from = cell(end_a(b)), to = cell(end_b(b));
    int farthest = 0;
    for (int axis = 0; axis < Dim; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      int apart = std::abs(from[k] - to[k]);
      if (grid.is_periodic(axis)) apart = std::min(apart, grid.cells(axis) - apart);
      farthest = std::max(farthest, apart);
    }
    if (farthest <= 1) continue;
    const auto& bond = bonds_[static_cast<std::size_t>(b)];
    throw RunError("the bond between particles " + std::to_string(bond.id_a) + " and " +
                   std::to_string(bond.id_b) +
                   " has grown longer than a cell is wide: give it a tensile strength, or a larger "
                   "search.skin");
  }
}

template class BondSet<2>;
template class BondSet<3>;

}  // namespace barchan
