#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <barchan/comm/base/communicator.hpp>

namespace barchan {

/// Everything that one rank received in a run, kept in memory in the order of each channel, so that
/// the run can be played again without communication:
///
///     auto tape = std::make_shared<Tape>();      run once: messages and reductions are recorded
///     tape->rewind();                            run again: they come from the tape, at once
///
/// The time of the second run is that of the first without its communication. Messages have a
/// channel for each link; reductions open theirs in the order in which they are made in both runs.
/// One thread at a time. Local.
class Tape {
 public:
  enum Channel { Sums, Verdicts, kNumFixed };
  /// Of messages over a link.
  [[nodiscard]] static int halo_channel(int link) { return -1 - 2 * link; }
  [[nodiscard]] static int bulk_channel(int link) { return -2 - 2 * link; }

  [[nodiscard]] bool is_playing() const { return is_playing_; }
  /// From now on the tape plays, from its beginning.
  void rewind();
  [[nodiscard]] int open_channel();

  /// @pre !is_playing()
  void record(int channel, std::span<const std::byte> bytes);
  [[nodiscard]] bool has_next(int channel) const;
  /// Valid as long as the tape. Errors: RunError when the recorded run was shorter.
  [[nodiscard]] std::span<const std::byte> next(int channel);

  [[nodiscard]] std::size_t bytes() const;  ///< recorded

 private:
  struct Track {
    std::vector<std::vector<std::byte>> blocks;
    std::vector<std::span<const std::byte>> records;
    std::size_t num_played = 0;
  };
  Track& track(int channel);
  [[nodiscard]] const Track* find(int channel) const;

  std::vector<Track> tracks_ = std::vector<Track>(kNumFixed);
  std::vector<Track> messages_;  ///< by channel, from −1 down
  int num_channels_ = kNumFixed;
  bool is_playing_ = false;
};

/// Sums over all ranks, recorded or played where the communicator has a tape. Collective, but when
/// played.
void taped_sum(const Communicator& communicator, std::span<std::int64_t> values);

/// A verdict that all ranks share, recorded or played where the communicator has a tape.
template <class Decide>
bool taped_verdict(const Communicator& communicator, Decide&& decide) {
  Tape* tape = communicator.tape();
  if (tape != nullptr && tape->is_playing()) return tape->next(Tape::Verdicts)[0] != std::byte{0};
  const bool verdict = decide();
  const std::byte byte{static_cast<unsigned char>(verdict ? 1 : 0)};
  if (tape != nullptr) tape->record(Tape::Verdicts, std::span(&byte, 1));
  return verdict;
}

}  // namespace barchan
