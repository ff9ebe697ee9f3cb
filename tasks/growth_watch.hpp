#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <barchan/tasks/notes.hpp>
#include <barchan/tasks/run_parts.hpp>

namespace barchan {

/// Notes where buffers have grown by a quarter. They grow by themselves; here it is only told.
class GrowthWatch {
 public:
  /// At the start, and whenever lists were made anew.
  template <int Dim>
  void look(RunParts<Dim>& run, std::int64_t step, Notes& notes);

 private:
  std::vector<std::size_t> sizes_;  ///< as last told
};

}  // namespace barchan
