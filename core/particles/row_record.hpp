#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <barchan/core/particles/fields.hpp>

namespace barchan {

/// All that the store has of one row, on its way to another place or another lane. Zeros at first.
template <int Dim>
class RowRecord {
  using Store = ParticleStore<Dim>;

 public:
  void take(const Store& store, std::int32_t row) {
    visit_places([&](const auto& array, std::size_t at, std::size_t bytes) {
      const auto& values = store.*array.values;
      const std::size_t begin = place(array, row);
      if (array.is_optional) has_optional_ = begin < values.size();
      if ((array.is_optional && has_optional_ == 0) || (array.is_of_heat && !store.has_heat))
        std::memset(bytes_.data() + at, 0, bytes);
      else
        std::memcpy(bytes_.data() + at, values.data() + begin, bytes);
    });
  }

  /// Optional arrays grow to hold the row where it brings something.
  void put(Store& store, std::int32_t row) const {
    visit_places([&](const auto& array, std::size_t at, std::size_t bytes) {
      if (array.is_of_heat && !store.has_heat) return;
      auto& values = store.*array.values;
      const std::size_t begin = place(array, row),
                        end = begin + static_cast<std::size_t>(array.width);
      if (array.is_optional && end > values.size()) {
        if (has_optional_ == 0) return;
        values.resize(end);
      }
      std::memcpy(values.data() + begin, bytes_.data() + at, bytes);
    });
  }

  void forget_optional() { has_optional_ = 0; }  ///< as ghosts have none

  /// The numbers of one array: values<&ParticleStore<Dim>::id>()
  template <auto Values>
  [[nodiscard]] auto* values() {
    return reinterpret_cast<Number<Values>*>(bytes_.data() + place_of<Values>());
  }
  template <auto Values>
  [[nodiscard]] const auto* values() const {
    return reinterpret_cast<const Number<Values>*>(bytes_.data() + place_of<Values>());
  }
  [[nodiscard]] bool is_valid() const { return has_optional_ <= 1; }

 private:
  template <auto Values>
  using Number = typename std::decay_t<decltype(std::declval<Store>().*Values)>::value_type;

  template <class T>
  static std::size_t place(const RowArray<Dim, T>& array, std::int32_t row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(array.width);
  }
  /// Calls visit(array, place in bytes_, bytes) for every array.
  template <class Visit>
  static constexpr std::size_t visit_places(Visit&& visit) {
    std::size_t at = 0;
    for_each_array<Dim>([&]<class T>(const RowArray<Dim, T>& array) {
      const std::size_t bytes = static_cast<std::size_t>(array.width) * sizeof(T);
      if (bytes > 0) visit(array, at, bytes);  // disks have no spin record
      at += bytes;
    });
    return at;
  }
  static constexpr std::size_t num_bytes() {
    return visit_places([](const auto&, std::size_t, std::size_t) {});
  }
  template <auto Values>
  static constexpr std::size_t place_of() {
    std::size_t found = 0;
    visit_places([&](const auto& array, std::size_t at, std::size_t /*bytes*/) {
      if constexpr (std::is_same_v<std::decay_t<decltype(array.values)>, decltype(Values)>)
        if (array.values == Values) found = at;
    });
    return found;
  }

  alignas(8) std::array<std::byte, num_bytes()> bytes_{};
  std::uint8_t has_optional_ = 0;  ///< this row in optional arrays: it has a place there
};

}  // namespace barchan
