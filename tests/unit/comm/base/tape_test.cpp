#include <barchan/comm/base/tape.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(Tape, PlaysEveryChannelInTheOrderOfItsRecords) {
  Tape tape;
  tape.record(Tape::halo_channel(0), bytes_of("one"));
  tape.record(Tape::halo_channel(1), bytes_of("other"));
  tape.record(Tape::halo_channel(0), bytes_of(""));
  tape.record(Tape::halo_channel(0), bytes_of("three"));

  tape.rewind();

  EXPECT_EQ(text_of(tape.next(Tape::halo_channel(0))), "one");
  EXPECT_EQ(text_of(tape.next(Tape::halo_channel(0))), "");
  EXPECT_EQ(text_of(tape.next(Tape::halo_channel(1))), "other");
  EXPECT_EQ(text_of(tape.next(Tape::halo_channel(0))), "three");
  EXPECT_EQ(tape.bytes(), 13U);
}

TEST(Tape, KeepsRecordsWhereTheyAreWhileItGrows) {
  Tape tape;
  const std::string large(700000, 'x');
  for (int n = 0; n < 5; ++n) {
    tape.record(Tape::bulk_channel(0), bytes_of(large + std::to_string(n)));
  }

  tape.rewind();

  for (int n = 0; n < 5; ++n) EXPECT_EQ(text_of(tape.next(Tape::bulk_channel(0))).back(), '0' + n);
}

TEST(Tape, GivesTheSameChannelsAgainWhenItPlays) {
  Tape tape;
  const int first = tape.open_channel(), second = tape.open_channel();

  tape.rewind();

  EXPECT_NE(first, second);
  EXPECT_EQ(tape.open_channel(), first);
  EXPECT_EQ(tape.open_channel(), second);
}

TEST(Tape, SaysThatTheRecordedRunWasShorter) {
  Tape tape;
  tape.rewind();

  EXPECT_FALSE(tape.has_next(Tape::Sums));
  EXPECT_THROW((void)tape.next(Tape::Sums), RunError);
}

}  // namespace
}  // namespace barchan
