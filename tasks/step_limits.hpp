#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <barchan/core/laws/stable_step.hpp>
#include <barchan/core/model/mass.hpp>
#include <barchan/core/particles/layout.hpp>
#include <barchan/tasks/stability.hpp>

// What limits of the time step are made of (stability.hpp).

namespace barchan {

inline double mass_in_motion(const ParticleData& p, int dimension) {
  return p.fixed ? kInfinite : mass_of(p, dimension);
}

inline double spin_gain(int dimension) {
  return dimension == 2 ? Layout<2>::kSpinGain : Layout<3>::kSpinGain;
}

/// The limits, one entry a name, each the smallest seen.
class Limits {
 public:
  void add(const std::string& what, double step, double safe_share = kAdvisedShare) {
    if (!(step < kInfinite)) return;
    const auto [it, is_new] = steps_.try_emplace(what, StepLimit{what, step, safe_share});
    if (!is_new) it->second.step = std::min(it->second.step, step);
  }
  [[nodiscard]] std::vector<StepLimit> sorted() const {
    std::vector<StepLimit> limits;
    for (const auto& [what, limit] : steps_) limits.push_back(limit);
    std::stable_sort(limits.begin(), limits.end(),
                     [](const StepLimit& a, const StepLimit& b) { return a.step < b.step; });
    return limits;
  }

 private:
  std::map<std::string, StepLimit> steps_;
};

/// Adds, for every particle with bonds, the limits of all of them together, under the name of each
/// of its laws.
void add_bonds(const Model& model, const ParticleSet& set, Limits& limits);

}  // namespace barchan
