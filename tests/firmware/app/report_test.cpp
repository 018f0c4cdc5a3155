// The envelope of reports, compared with bytes assembled by hand (checksum: Python's zlib.crc32).
#include "firmware/app/protocol/report.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace {

using firmware::Message;
using firmware::MessageType;
using firmware::Status;

hal::HidReport report_of(std::initializer_list<int> head, std::initializer_list<int> crc) {
  hal::HidReport report{};
  std::size_t i = 0;
  for (const int byte : head) report[i++] = static_cast<std::byte>(byte);
  i = 60;
  for (const int byte : crc) report[i++] = static_cast<std::byte>(byte);
  return report;
}

/// Version 1, jog, sequence 0x1234, 8 bytes: axis 1, -12.5 mm/s (0xC1480000).
const hal::HidReport kJogReport = report_of(
    {0x01, 0x23, 0x34, 0x12, 0x00, 0x08, 0, 0, 0x01, 0, 0, 0, 0x00, 0x00, 0x48, 0xC1}, {0xA0, 0x81, 0xBB, 0xAB});

TEST(Report, IsThePagesBytes) {
  Message message;
  message.type = MessageType::jog;
  message.sequence = 0x1234;
  message.put(firmware::JogRequest{1, {}, -12.5F});
  EXPECT_EQ(firmware::encode(message), kJogReport);
  Message decoded;
  ASSERT_EQ(firmware::decode(kJogReport, decoded), Status::ok);
  EXPECT_EQ(decoded, message);
  firmware::JogRequest jog;
  ASSERT_TRUE(decoded.get(jog));
  EXPECT_EQ(jog.axis, 1);
  EXPECT_EQ(jog.velocity, -12.5F);
}

TEST(Report, NoFlippedBitPasses) {
  for (std::size_t byte = 0; byte < kJogReport.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      hal::HidReport damaged = kJogReport;
      damaged[byte] ^= static_cast<std::byte>(1 << bit);
      Message message;
      EXPECT_EQ(firmware::decode(damaged, message), Status::damaged) << byte << " " << bit;
    }
  }
}

hal::HidReport sealed(hal::HidReport report) {
  const std::uint32_t crc = firmware::crc32(std::span(report).first(60));
  std::memcpy(report.data() + 60, &crc, 4);
  return report;
}

TEST(Report, AnotherVersionAndALengthThatCannotBeAreRefused) {
  Message message;
  hal::HidReport other = kJogReport;
  other[0] = std::byte{2};
  EXPECT_EQ(firmware::decode(sealed(other), message), Status::wrong_version);
  other = kJogReport;
  other[5] = std::byte{53};
  EXPECT_EQ(firmware::decode(sealed(other), message), Status::damaged);
}

TEST(Report, APayloadOfAnotherLengthIsNotTaken) {
  Message message;
  message.put(firmware::JogRequest{1, {}, 1.0F});
  firmware::MoveRequest move{};
  move.axis = 7;
  EXPECT_FALSE(message.get(move));
  EXPECT_EQ(move.axis, 7) << "untouched";
}

TEST(MoveRequest, CarriesCountsBeyond32Bits) {
  for (const std::int64_t counts :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1} << 40, -(std::int64_t{1} << 40), std::int64_t{4294967295}})
    EXPECT_EQ(firmware::MoveRequest::to(0, counts).counts(), counts);
}

}  // namespace
