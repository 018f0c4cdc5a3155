// The USB/IP controller against the other end of its socket: the bytes that the kernel's vhci-hcd sends and must
// receive, from the kernel's Documentation/usb/usbip_protocol.rst.
#include "hal/usbip/usbip_controller.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <vector>

#include "hal/usb_identity.hpp"

namespace {

using namespace std::chrono_literals;
using hal::HidReport;
using hal::tinyusb::HidPort;
using hal::usbip::UsbipController;
using Bytes = std::vector<std::uint8_t>;

struct Reply {
  std::uint32_t command = 0, sequence = 0;
  std::int32_t status = 0;
  Bytes data;
};

void append_word(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t word(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
  return value;
}

class UsbipSocket : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(port.start("TEST"));
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    host = ends[0];
    controller.emplace(ends[1], port, 0us);
  }
  void TearDown() override {
    controller.reset();
    if (host >= 0) close(host);
  }

  void send(const Bytes& bytes) const {
    ASSERT_EQ(write(host, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  static Bytes submit(std::uint32_t sequence, bool in, std::uint32_t endpoint, std::uint32_t length,
                      const Bytes& setup = Bytes(8), const Bytes& data = {}) {
    Bytes message;
    for (const std::uint32_t value : {1u, sequence, 0x00010002u, in ? 1u : 0u, endpoint, 0u, length, 0u, 0u, 0u})
      append_word(message, value);
    message.insert(message.end(), setup.begin(), setup.end());
    message.insert(message.end(), data.begin(), data.end());
    return message;
  }

  static Bytes unlink(std::uint32_t sequence, std::uint32_t victim) {
    Bytes message;
    for (const std::uint32_t value : {2u, sequence, 0x00010002u, 0u, 0u, victim}) append_word(message, value);
    message.resize(48);
    return message;
  }

  Bytes read_bytes(std::size_t size) const {
    Bytes bytes(size);
    std::size_t got = 0;
    while (got < size) {
      const ssize_t part = read(host, bytes.data() + got, size - got);
      if (part <= 0) break;
      got += static_cast<std::size_t>(part);
    }
    bytes.resize(got);
    return bytes;
  }

  /// The pending reply, if any; `in`: whether data follow it.
  std::optional<Reply> reply(bool in) const {
    pollfd waiting{host, POLLIN, 0};
    if (poll(&waiting, 1, 0) != 1) return std::nullopt;
    const Bytes header = read_bytes(48);
    if (header.size() != 48) return std::nullopt;
    Reply result{word(header, 0), word(header, 4), static_cast<std::int32_t>(word(header, 20)), {}};
    if (result.command == 3 && in) result.data = read_bytes(word(header, 24));
    return result;
  }

  std::optional<Reply> exchange(const Bytes& message, bool in) {
    send(message);
    EXPECT_TRUE(controller->serve(0ms));
    return reply(in);
  }

  void configure() {
    const auto done = exchange(submit(1, false, 0, 0, {0x00, 9, 1, 0, 0, 0, 0, 0}), false);
    ASSERT_TRUE(done && done->status == 0);
    ASSERT_TRUE(port.is_configured());
  }

  HidPort port;
  int host = -1;
  std::optional<UsbipController> controller;
};

HidReport report_of(std::uint8_t seed) {
  HidReport report{};
  for (std::size_t i = 0; i < report.size(); ++i) report[i] = static_cast<std::byte>(seed + i);
  return report;
}

Bytes bytes_of(const HidReport& report) {
  Bytes bytes;
  for (const std::byte byte : report) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

TEST_F(UsbipSocket, AnswersRequestsOfTheControlPipe) {
  const auto device = exchange(submit(77, true, 0, 18, {0x80, 6, 0, 1, 0, 0, 18, 0}), true);
  ASSERT_TRUE(device);
  EXPECT_EQ(device->command, 3u);
  EXPECT_EQ(device->sequence, 77u);
  EXPECT_EQ(device->status, 0);
  ASSERT_EQ(device->data.size(), 18u);
  EXPECT_EQ(device->data[8] | device->data[9] << 8, hal::kUsbVendor);
  const auto all = exchange(submit(78, true, 0, 255, {0x80, 6, 0, 2, 0, 0, 255, 0}), true);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->data.size(), 41u) << "shorter than asked";
}

TEST_F(UsbipSocket, StallsWhatTheDeviceDoesNotKnow) {
  const auto qualifier = exchange(submit(5, true, 0, 10, {0x80, 6, 0, 6, 0, 0, 10, 0}), true);
  ASSERT_TRUE(qualifier);
  EXPECT_EQ(qualifier->status, -32);
  EXPECT_TRUE(qualifier->data.empty());
  const auto feature = exchange(submit(6, false, 0, 64, {0x21, 9, 0, 3, 0, 0, 64, 0}, Bytes(64)), false);
  ASSERT_TRUE(feature);
  EXPECT_EQ(feature->status, -32) << "data that came with the request are skipped";
  configure();
}

TEST_F(UsbipSocket, HoldsATransferUntilThereIsAReport) {
  configure();
  EXPECT_FALSE(exchange(submit(10, true, 1, 64), true)) << "NAK: no reply";
  ASSERT_TRUE(port.send(report_of(3)));
  const auto got = reply(true);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->sequence, 10u);
  EXPECT_EQ(got->data, bytes_of(report_of(3)));
  ASSERT_TRUE(port.send(report_of(4)));
  EXPECT_FALSE(reply(true)) << "nobody asked";
  const auto next = exchange(submit(11, true, 1, 64), true);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->data, bytes_of(report_of(4)));
}

TEST_F(UsbipSocket, HoldsWhatTheBoardHasNoRoomFor) {
  configure();
  std::uint8_t sent = 0;
  while (sent < 100 && exchange(submit(100u + sent, false, 1, 64, Bytes(8), bytes_of(report_of(sent))), false)) ++sent;
  ASSERT_LT(sent, 100);
  HidReport got{};
  ASSERT_TRUE(port.receive(got));
  const auto late = reply(false);
  ASSERT_TRUE(late) << "the waiting transfer is accepted once there is room";
  EXPECT_EQ(late->sequence, 100u + sent);
  for (std::uint8_t i = 0; i <= sent; ++i) {
    EXPECT_EQ(got, report_of(i));
    port.poll();
    port.receive(got);
  }
}

TEST_F(UsbipSocket, TakesBackATransferThatWaits) {
  configure();
  EXPECT_FALSE(exchange(submit(20, true, 1, 64), true));
  const auto taken = exchange(unlink(21, 20), false);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->command, 4u);
  EXPECT_EQ(taken->sequence, 21u);
  EXPECT_EQ(taken->status, -104) << "ECONNRESET: the transfer was waiting";
  const auto late = exchange(unlink(22, 20), false);
  ASSERT_TRUE(late);
  EXPECT_EQ(late->status, 0) << "it has already been cancelled";
  ASSERT_TRUE(port.send(report_of(1)));
  EXPECT_FALSE(reply(true)) << "a cancelled transfer gets no reply";
  const auto next = exchange(submit(23, true, 1, 64), true);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->data, bytes_of(report_of(1))) << "the report of the cancelled transfer is not lost";
}

TEST_F(UsbipSocket, StallsAnEndpointThatDoesNotExist) {
  configure();
  const auto answer = exchange(submit(30, true, 3, 64), true);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, -32);
}

TEST_F(UsbipSocket, UnderstandsMessagesThatComeInPieces) {
  configure();
  const Bytes message = submit(40, false, 1, 64, Bytes(8), bytes_of(report_of(9)));
  for (const std::uint8_t byte : message) {
    EXPECT_FALSE(reply(false));
    send({byte});
    ASSERT_TRUE(controller->serve(0ms));
  }
  EXPECT_TRUE(reply(false));
  HidReport got{};
  ASSERT_TRUE(port.receive(got));
  EXPECT_EQ(got, report_of(9));
}

TEST_F(UsbipSocket, UnderstandsMessagesThatComeTogether) {
  configure();
  Bytes both = submit(50, false, 1, 64, Bytes(8), bytes_of(report_of(1)));
  const Bytes second = submit(51, true, 0, 18, {0x80, 6, 0, 1, 0, 0, 18, 0});
  both.insert(both.end(), second.begin(), second.end());
  const auto first = exchange(both, false);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->sequence, 50u);
  EXPECT_EQ(reply(true)->sequence, 51u);
}

TEST_F(UsbipSocket, MovesOneReportAFrame) {
  controller.reset();
  close(host);
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  host = ends[0];
  controller.emplace(ends[1], port);
  const auto begin = std::chrono::steady_clock::now();  // the first frame begins when the endpoint opens
  configure();
  constexpr std::uint8_t kReports = 8;
  for (std::uint8_t i = 0; i < kReports; ++i) {
    ASSERT_TRUE(port.send(report_of(i)));
    send(submit(100u + i, true, 1, 64));
  }
  for (std::uint8_t got = 0; got < kReports;) {
    ASSERT_TRUE(controller->serve(10ms));
    for (; const auto next = reply(true); ++got) EXPECT_EQ(next->data, bytes_of(report_of(got)));
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begin, (kReports - 1) * 1ms);
}

TEST_F(UsbipSocket, EndsWhenTheHostGoes) {
  configure();
  close(host);
  host = -1;
  EXPECT_FALSE(controller->serve(0ms));
  EXPECT_FALSE(port.is_configured());
  EXPECT_FALSE(port.send(report_of(1)));
}

TEST_F(UsbipSocket, EndsOnWhatIsNotUsbip) {
  configure();
  send(Bytes(48, 0xEE));
  EXPECT_FALSE(controller->serve(0ms));
  EXPECT_FALSE(port.is_configured());
}

TEST_F(UsbipSocket, EndsOnATransferOfAbsurdLength) {
  configure();
  send(submit(60, false, 1, 0x7FFFFFFF));
  EXPECT_FALSE(controller->serve(0ms));
}

}  // namespace
