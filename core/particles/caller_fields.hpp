#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace barchan {

/// A field of the caller's own: numbers of every particle that barchan carries along and never
/// reads.
struct CallerField {
  std::string name;
  int components = 1;
  int at = 0;  ///< within the numbers that a particle carries

  /// As checkpoints keep it; names end with zeros.
  struct Saved {
    std::array<char, 44> name{};
    std::int32_t components = 0;
  };
};

/// Those of a run, side by side in the rows of ParticleStore::carried:
///
///     | dose | flux x y z | …        added in this order; none is ever taken away
class CallerFields {
 public:
  static constexpr int kMostNumbers = 256;  ///< of a particle, in all fields

  [[nodiscard]] const std::vector<CallerField>& all() const { return all_; }
  [[nodiscard]] int num_numbers() const;  ///< of a particle
  /// Null: there is none.
  [[nodiscard]] const CallerField* find(std::string_view name) const;
  /// What is wrong with such a field beside these; empty: nothing.
  [[nodiscard]] std::string fault_of(std::string_view name, int components) const;
  /// @pre fault_of() finds nothing
  void add(std::string_view name, int components);

  [[nodiscard]] std::vector<CallerField::Saved> saved() const;
  /// @return false: these are no fields
  [[nodiscard]] bool restore(std::span<const CallerField::Saved> saved);

 private:
  std::vector<CallerField> all_;
};

}  // namespace barchan
