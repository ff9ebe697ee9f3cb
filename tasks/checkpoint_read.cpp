#include <barchan/tasks/checkpoint_read.hpp>

#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/tasks/agree.hpp>

namespace barchan {

RankFile::RankFile(const std::string& checkpoint, const Manifest& manifest, std::size_t rank)
    : bytes_(read_bytes(checkpoint + "/" + rank_file_name(rank), manifest.files[rank].seal.bytes)),
      view_(bytes_, checkpoint + "/" + rank_file_name(rank)) {
  const RankFileSeal listed = manifest.files[rank].seal, found = view_.seal();
  const RankFileHeader& header = view_.header();
  const bool is_listed = listed.bytes == found.bytes && listed.hash == found.hash &&
                         header.step == manifest.step && header.rank == rank &&
                         header.num_ranks == manifest.files.size() &&
                         header.dimension == static_cast<std::uint32_t>(manifest.dimension);
  if (is_listed) return;
  throw InputError(SourcePlace{checkpoint + "/" + rank_file_name(rank), 0, 0},
                   "is not the file that the manifest lists", "take another checkpoint");
}

Manifest read_shared_manifest(const Communicator& communicator, const std::string& checkpoint) {
  std::string text;
  agree(communicator, [&] {
    if (communicator.is_root()) text = manifest_text(read_manifest(checkpoint));
  });
  return parse_manifest(communicator.bcast(text), checkpoint + "/" + kManifestName);
}

}  // namespace barchan
