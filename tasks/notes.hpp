#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace barchan {

/// An event of a run, for its log.
struct Note {
  std::string text;  ///< a line
  bool is_warning = false;
};

/// Events on this rank that nobody has taken yet; rank 0 has those that all ranks know.
class Notes {
 public:
  void add(std::int64_t step, const std::string& text, bool is_warning = false) {
    notes_.push_back({"step " + std::to_string(step) + ": " + text, is_warning});
  }
  [[nodiscard]] std::vector<Note> take() { return std::exchange(notes_, {}); }

 private:
  std::vector<Note> notes_;
};

}  // namespace barchan
