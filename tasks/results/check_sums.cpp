#include <barchan/tasks/results/check_sums.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>

namespace barchan {

void check_sums(const Simulation& simulation, const Measures& m) {
  std::vector<std::string> wrong;
  const auto look = [&](double value, std::string_view what) {
    const bool is_new = wrong.empty() || wrong.back() != what;
    if (!std::isfinite(value) && is_new) wrong.emplace_back(what);
  };
  look(m.kinetic.value(), "the kinetic energy");
  look(m.elastic.value(), "the elastic energy");
  look(m.gravitational.value(), "the gravitational energy");
  for (const ExactSum& component : m.momentum) look(component.value(), "the momentum");
  const auto walls = simulation.walls();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const std::string& name = simulation.model().walls[w].name;
    for (int c = 0; c < 3; ++c) look(walls[w].force[c], fmt::format("the force on '{}'", name));
    look(walls[w].work, fmt::format("the work of '{}'", name));
  }
  if (wrong.empty()) return;
  throw AgreedError(
      fmt::format("at step {} {} {} not finite, or beyond the range of numbers (1.8e308); smaller "
                  "masses and speeds, or other units, would help",
                  simulation.step(), fmt::join(wrong, ", "), wrong.size() == 1 ? "is" : "are"));
}

}  // namespace barchan
