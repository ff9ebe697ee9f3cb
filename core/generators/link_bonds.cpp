#include <barchan/core/generators/link_bonds.hpp>

#include <algorithm>
#include <set>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/generators/close_pairs.hpp>

namespace barchan {
namespace {

/// Links particles of one source, which are those behind the `first` of a set.
class Linker {
 public:
  Linker(const Model& model, const ParticleSource& source, std::size_t first, ParticleSet& set)
      : model_(model), source_(source), first_(first), set_(set) {}

  void link() {
    const std::size_t before = set_.bonds.size();
    if (!source_.links.pairs.empty()) {
      link_pairs();
    } else if (std::holds_alternative<RingSource>(source_.kind) && !source_.links.gap) {
      link_ring();
    } else {
      link_touching();
    }
    if (set_.bonds.size() == before) refuse_none();
  }

 private:
  void add(std::int64_t a, std::int64_t b) {
    set_.bonds.push_back({std::min(a, b), std::max(a, b), *source_.bond});
  }

  void link_pairs() {
    std::unordered_set<std::int64_t> ids;
    for (const ParticleData& p : set_.particles) ids.insert(p.id);
    std::set<std::pair<std::int64_t, std::int64_t>> linked;
    for (const auto& [a, b] : source_.links.pairs) {
      if (!linked.insert(std::minmax(a, b)).second)
        throw InputError(source_.links.place, fmt::format("bond_pairs links {} and {} twice", a, b),
                         "a pair has at most one bond");
      for (const std::int64_t id : {a, b}) {
        if (ids.contains(id)) continue;
        throw InputError(source_.links.place, fmt::format("there is no particle {} to link", id),
                         "name ids of this source or of those before it");
      }
      add(a, b);
    }
  }

  void link_ring() {
    const std::size_t count = set_.particles.size() - first_;
    for (std::size_t k = 0; k < count; ++k)
      add(set_.particles[first_ + k].id, set_.particles[first_ + (k + 1) % count].id);
  }

  [[nodiscard]] PairSpace space() const {
    return {model_.dimension, model_.domain.lo, model_.domain.hi, model_.domain.periodic};
  }

  [[nodiscard]] std::vector<Grain> grains() const {
    std::vector<Grain> grains;
    for (std::size_t i = first_; i < set_.particles.size(); ++i)
      grains.push_back({set_.particles[i].position, set_.particles[i].radius});
    return grains;
  }

  /// Calls use(i, j, gap between the surfaces, sum of the radii) for pairs up to `gap` apart.
  template <class Use>
  void for_each_pair(const std::vector<Grain>& grains, double gap, Use use) const {
    const PairSpace around = space();
    for_each_close_pair(around, grains, gap, [&](std::uint32_t i, std::uint32_t j) {
      const double sum = grains[i].radius + grains[j].radius;
      use(i, j, around.difference(grains[i].position, grains[j].position).norm(), sum);
      return true;
    });
  }

  [[nodiscard]] static double largest_radius(const std::vector<Grain>& grains) {
    double largest = 0.0;
    for (const Grain& grain : grains) largest = std::max(largest, grain.radius);
    return largest;
  }

  void link_touching() {
    const std::vector<Grain> grains = this->grains();
    const double largest = largest_radius(grains);
    const auto gap = source_.links.gap;
    if (gap) check_gap(*gap, largest);
    const std::size_t before = set_.bonds.size();
    for_each_pair(grains, gap.value_or(2.0 * kTouchGap * largest),
                  [&](std::uint32_t i, std::uint32_t j, double distance, double sum) {
                    if (distance <= (gap ? sum + *gap : (1.0 + kTouchGap) * sum))
                      add(set_.particles[first_ + i].id, set_.particles[first_ + j].id);
                  });
    std::sort(set_.bonds.begin() + static_cast<std::ptrdiff_t>(before), set_.bonds.end(),
              [](const BondData& a, const BondData& b) {
                return a.id_a != b.id_a ? a.id_a < b.id_a : a.id_b < b.id_b;
              });
  }

  void check_gap(double gap, double largest) const {
    for (int axis = 0; axis < model_.dimension; ++axis) {
      const double length = model_.domain.hi[axis] - model_.domain.lo[axis];
      if (2.0 * (2.0 * largest + gap) < length) continue;
      throw InputError(source_.links.place,
                       fmt::format("bond_gap = {:g} m reaches across half the domain", gap),
                       "keep it in the order of the radii");
    }
  }

  [[noreturn]] void refuse_none() const {
    const std::vector<Grain> grains = this->grains();
    double least = largest_radius(grains);
    bool is_found = false;
    for_each_pair(grains, least, [&](std::uint32_t, std::uint32_t, double distance, double sum) {
      is_found = true;
      least = std::min(least, distance - sum);
    });
    throw InputError(
        source_.links.place,
        fmt::format("bond = \"{}\" links nothing: no two particles of this source touch{}",
                    model_.bond_laws[static_cast<std::size_t>(*source_.bond)].name,
                    is_found ? fmt::format(", the nearest have a gap of {:.6g} m", least) : ""),
        "give a bond_gap [m] or bond_pairs, or leave bond out");
  }

  const Model& model_;
  const ParticleSource& source_;
  std::size_t first_;
  ParticleSet& set_;
};

}  // namespace

void link_bonds(const Model& model, const ParticleSource& source, std::size_t first,
                ParticleSet& set) {
  Linker(model, source, first, set).link();
}

}  // namespace barchan
