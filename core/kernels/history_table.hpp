#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace barchan {

/// Rows, each with the history of a contact beside it.
template <class Row>
struct HistoryTable {
  int length = 0;  ///< numbers a row
  std::vector<Row> rows;
  std::vector<double> numbers;

  [[nodiscard]] std::size_t size() const { return rows.size(); }
  [[nodiscard]] double* history(std::size_t k) {
    return numbers.data() + k * static_cast<std::size_t>(length);
  }
  [[nodiscard]] const double* history(std::size_t k) const {
    return numbers.data() + k * static_cast<std::size_t>(length);
  }
  void clear(int new_length) {
    length = new_length;
    rows.clear();
    numbers.clear();
  }
  void resize(std::size_t n) {
    rows.resize(n);
    numbers.resize(n * static_cast<std::size_t>(length));
  }
  /// @return its history, zero
  double* push(const Row& row) {
    rows.push_back(row);
    numbers.resize(rows.size() * static_cast<std::size_t>(length), 0.0);
    return history(rows.size() - 1);
  }
  /// Gives memory back where there is much more than is needed, but for `room` rows.
  void trim(std::size_t room) {
    if (rows.capacity() <= rows.size() + rows.size() / 8 + 2 * room) return;
    const std::size_t wanted = rows.size() + rows.size() / 16 + room;
    const auto fit = [](auto& column, std::size_t n) {
      std::remove_reference_t<decltype(column)> fitting;
      fitting.reserve(n);
      fitting.assign(column.begin(), column.end());
      column.swap(fitting);
    };
    fit(rows, wanted);
    fit(numbers, wanted * static_cast<std::size_t>(length));
  }
  [[nodiscard]] std::size_t bytes() const {
    return rows.capacity() * sizeof(Row) + numbers.capacity() * sizeof(double);
  }
};

}  // namespace barchan
