#include "support/input.hpp"
#include "support/lanes.hpp"
#include "support/slot_header.hpp"

// What one rank may get from another: slot headers, arrivals, ghosts, halos, returned forces. Two
// lanes side by side exchange real messages; one of them is changed as the input says, then both go
// on for as long as they accept it.
//
//   input  | kind of message | dimension, side, whole or edits | edits or a whole message |
//   edits  | new length, 2 bytes, 0: as it was | offset, 2 bytes, and a byte to put there | … |

namespace barchan::fuzz {
namespace {

enum Kind { Header, Arrivals, Ghosts, Halo, Results, kNumKinds };
enum Flag : std::uint8_t { kToRight = 1, kIs3D = 2, kIsWhole = 4 };

std::size_t number_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::size_t>(bytes[at]) | std::to_integer<std::size_t>(bytes[at + 1])
                                                       << 8U;
}

void edit(Bytes& message, std::span<const std::byte> edits) {
  if (edits.size() >= 2 && number_at(edits, 0) != 0) message.resize(number_at(edits, 0));
  for (std::size_t at = 2; at + 3 <= edits.size() && !message.empty(); at += 3)
    message[number_at(edits, at) % message.size()] = edits[at + 2];
}

template <int Dim>
void read(Kind kind, std::uint8_t flags, std::span<const std::byte> bytes) {
  const auto change = [&](Bytes& message) {
    if ((flags & kIsWhole) != 0)
      message.assign(bytes.begin(), bytes.end());
    else
      edit(message, bytes);
  };
  Sample<Dim> sample(kind == Results);
  const bool to_right = (flags & kToRight) != 0;
  if (kind == Arrivals) sample.arrivals(to_right, change);
  if (kind == Ghosts) sample.ghosts(to_right, change);
  if (kind == Halo) sample.halo(to_right, change);
  if (kind == Results) sample.results(change);
}

}  // namespace
}  // namespace barchan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace barchan::fuzz;
  if (size < 2) return 0;
  const auto kind = static_cast<Kind>(data[0] % kNumKinds);
  const auto bytes = bytes_of(data + 2, size - 2);
  expect_run_error([&] {
    if (kind == Header)
      read_slot_header(bytes);
    else if ((data[1] & kIs3D) != 0)
      read<3>(kind, data[1], bytes);
    else
      read<2>(kind, data[1], bytes);
  });
  return 0;
}
