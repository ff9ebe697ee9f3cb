#include <barchan/comm/base/tape.hpp>

#include <algorithm>
#include <cstring>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

}  // namespace

void Tape::rewind() {
  is_playing_ = true;
  num_channels_ = kNumFixed;
  for (Track& track : tracks_) track.num_played = 0;
  for (Track& track : messages_) track.num_played = 0;
}

int Tape::open_channel() {
  const int channel = num_channels_++;
  if (static_cast<std::size_t>(num_channels_) > tracks_.size()) {
    tracks_.resize(static_cast<std::size_t>(num_channels_));
  }
  return channel;
}

Tape::Track& Tape::track(int channel) {
  if (channel >= 0) return tracks_[static_cast<std::size_t>(channel)];
  const auto at = static_cast<std::size_t>(-1 - channel);
  if (at >= messages_.size()) messages_.resize(at + 1);
  return messages_[at];
}

const Tape::Track* Tape::find(int channel) const {
  const auto& tracks = channel >= 0 ? tracks_ : messages_;
  const auto at = static_cast<std::size_t>(channel >= 0 ? channel : -1 - channel);
  return at < tracks.size() ? &tracks[at] : nullptr;
}

void Tape::record(int channel, std::span<const std::byte> bytes) {
  Track& mine = track(channel);
  auto& blocks = mine.blocks;  // never grown beyond what was reserved: records point into them
  if (blocks.empty() || blocks.back().capacity() - blocks.back().size() < bytes.size()) {
    blocks.emplace_back().reserve(std::max(kBlockBytes, bytes.size()));
  }
  std::vector<std::byte>& block = blocks.back();
  const std::size_t begin = block.size();
  block.insert(block.end(), bytes.begin(), bytes.end());
  mine.records.emplace_back(block.data() + begin, bytes.size());
}

bool Tape::has_next(int channel) const {
  const Track* mine = find(channel);
  return mine != nullptr && mine->num_played < mine->records.size();
}

std::span<const std::byte> Tape::next(int channel) {
  if (!has_next(channel)) {
    throw RunError("the recorded run ends here: it had fewer steps, or took another course");
  }
  Track& mine = track(channel);
  return mine.records[mine.num_played++];
}

std::size_t Tape::bytes() const {
  std::size_t sum = 0;
  for (const auto* tracks : {&tracks_, &messages_}) {
    for (const Track& track : *tracks) {
      for (const auto& block : track.blocks) sum += block.size();
    }
  }
  return sum;
}

void taped_sum(const Communicator& communicator, std::span<std::int64_t> values) {
  Tape* tape = communicator.tape();
  if (tape != nullptr && tape->is_playing()) {
    const auto played = tape->next(Tape::Sums);
    std::memcpy(values.data(), played.data(), std::min(played.size(), values.size_bytes()));
    return;
  }
  communicator.allreduce_sum(values);
  if (tape != nullptr) tape->record(Tape::Sums, std::as_bytes(values));
}

}  // namespace barchan
