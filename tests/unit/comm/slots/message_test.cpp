#include <barchan/comm/slots/message.hpp>

#include <array>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace barchan {
namespace {

TEST(Message, ReadsTheHeaderThatWasWritten) {
  std::array<std::byte, kHeaderBytes> memory{};
  MessageHeader header;
  header.number = 7;
  header.bytes = 100;
  header.has_more = 1;

  write_header(header, memory.data());

  EXPECT_EQ(read_header(memory.data()).number, 7U);
  EXPECT_EQ(read_header(memory.data()).bytes, 100U);
  EXPECT_EQ(fault_of(read_header(memory.data()), 7, 100), "");
}

TEST(Message, SaysWhatIsWrongWithAHeader) {
  MessageHeader header;
  header.number = 7;
  header.bytes = 101;

  EXPECT_NE(fault_of(header, 8, 200).find("7 instead of 8"), std::string::npos);
  EXPECT_NE(fault_of(header, 7, 100).find("101 bytes where at most 100"), std::string::npos);
  header.has_more = 3;
  EXPECT_NE(fault_of(header, 7, 200), "");
}

TEST(Message, AcceptsNoRandomBytes) {
  std::mt19937_64 random(1);

  for (int trial = 0; trial < 10000; ++trial) {
    std::array<std::uint64_t, kHeaderBytes / 8> words{};
    for (auto& word : words) word = random();
    std::array<std::byte, kHeaderBytes> memory{};
    std::memcpy(memory.data(), words.data(), kHeaderBytes);
    EXPECT_NE(fault_of(read_header(memory.data()), 12, 4096), "");
  }
}

TEST(Message, NamesItselfForAReport) {
  EXPECT_EQ(describe({Channel::Halo, 3, 17}, 2), "halo message 17 from rank 2 (link 3)");
}

}  // namespace
}  // namespace barchan
