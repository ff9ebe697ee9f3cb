#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <barchan/core/base/error.hpp>

namespace barchan {

/// Appends plain records to a message.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}

  template <class T>
  void put(const T& record) {
    put_all(std::span<const T>(&record, 1));
  }
  template <class T>
  void put_all(std::span<const T> records) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = out_.size();
    out_.resize(at + records.size_bytes());
    if (!records.empty()) std::memcpy(out_.data() + at, records.data(), records.size_bytes());
  }
  /// A count, then the records.
  template <class T>
  void put_counted(const std::vector<T>& records) {
    put(static_cast<std::uint64_t>(records.size()));
    put_all(std::span<const T>(records));
  }

 private:
  std::vector<std::byte>& out_;
};

/// Takes a message apart; a message that is too short or too long is a RunError, never an overrun.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> in) : in_(in) {}

  template <class T>
  T take() {
    T record;
    require(sizeof(T));
    std::memcpy(&record, in_.data(), sizeof(T));
    in_ = in_.subspan(sizeof(T));
    return record;
  }
  template <class T>
  std::vector<T> take_counted() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto n = take<std::uint64_t>();
    if (n > in_.size() / sizeof(T)) throw RunError("a message is shorter than it says");
    std::vector<T> records(n);
    if (n > 0) std::memcpy(records.data(), in_.data(), n * sizeof(T));
    in_ = in_.subspan(n * sizeof(T));
    return records;
  }
  void finish() const {
    if (!in_.empty()) throw RunError("a message is longer than it says");
  }
  [[nodiscard]] bool empty() const { return in_.empty(); }

 private:
  void require(std::size_t bytes) const {
    if (in_.size() < bytes) throw RunError("a message is shorter than it says");
  }
  std::span<const std::byte> in_;
};

}  // namespace barchan
