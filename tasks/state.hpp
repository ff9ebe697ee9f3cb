#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace barchan {

/// A state of a simulation in memory: this rank's share. Any number of them may be kept; each is
/// good for as long as its simulation lives.
///
///     State before = sim.save();
///     sim.run(10);
///     sim.load(before);            // as if these ten steps had not been
class State {
 public:
  State();  ///< empty, to be saved to
  ~State();
  State(State&&) noexcept;
  State& operator=(State&&) noexcept;

  [[nodiscard]] bool is_empty() const;
  [[nodiscard]] std::int64_t step() const;  ///< that it is at the beginning of
  [[nodiscard]] std::size_t bytes() const;  ///< on this rank

  struct Data;

 private:
  friend class Simulation;
  std::unique_ptr<Data> data_;
};

}  // namespace barchan
