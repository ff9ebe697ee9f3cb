#pragma once

#include <string>
#include <vector>

#include <barchan/comm/base/communicator.hpp>
#include <barchan/core/checkpoint/manifest.hpp>
#include <barchan/core/checkpoint/rank_file.hpp>

namespace barchan {

/// One rank's file of a checkpoint, read, verified, and the very one that the manifest lists.
class RankFile {
 public:
  /// Errors: InputError.
  RankFile(const std::string& checkpoint, const Manifest& manifest, std::size_t rank);
  [[nodiscard]] const RankFileView& view() const { return view_; }

 private:
  std::vector<std::byte> bytes_;
  RankFileView view_;
};

/// The manifest, read by rank 0 for all. Collective. Errors: InputError.
[[nodiscard]] Manifest read_shared_manifest(const Communicator& communicator,
                                            const std::string& checkpoint);

}  // namespace barchan
