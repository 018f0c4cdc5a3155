// The board's USB function on TinyUSB, against a host in memory: enumeration, reports, refusals, suspend.
#include <gtest/gtest.h>

#include <array>

#include "hal/usb_identity.hpp"
#include "tests/hal/tinyusb/mock_bus.hpp"

namespace {

using hal::HidReport;
using hal::tinyusb::HidPort;
using usb_test::Bytes;
using usb_test::MockBus;
using usb_test::Outcome;
using usb_test::Request;
using usb_test::Transfer;

constexpr std::uint8_t kIn = 0x81, kOut = 0x01;
constexpr const char* kSerial = "0123456789ABCDEF01234567";

// Requests as a host sends them: USB 2.0, table 9-3; HID 1.11, chapter 7.
constexpr Request get_descriptor(std::uint16_t value, std::uint16_t length) { return {0x80, 6, value, 0, length}; }
constexpr Request kGetReportDescriptor{0x81, 6, 0x2200, 0, 255};

HidReport report_of(std::uint8_t seed) {
  HidReport report{};
  for (std::size_t i = 0; i < report.size(); ++i) report[i] = static_cast<std::byte>(seed + 3 * i);
  return report;
}

Bytes bytes_of(const HidReport& report) {
  Bytes bytes;
  for (const std::byte byte : report) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

class HidPortOnBus : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(port.start(kSerial));
    bus.reset();
  }

  HidPort port;
  MockBus bus{port};
};

TEST_F(HidPortOnBus, TellsWhoItIs) {
  const Transfer device = bus.control(get_descriptor(0x0100, 18));
  ASSERT_EQ(device.outcome, Outcome::done);
  const Bytes expected{18,
                       1,
                       0x00,
                       0x02,
                       0,
                       0,
                       0,
                       64,
                       hal::kUsbVendor & 0xFF,
                       hal::kUsbVendor >> 8,
                       hal::kUsbProduct & 0xFF,
                       hal::kUsbProduct >> 8,
                       0x00,
                       0x01,
                       1,
                       2,
                       3,
                       1};
  EXPECT_EQ(device.data, expected);
  EXPECT_EQ(bus.control(get_descriptor(0x0100, 8)).data, Bytes(expected.begin(), expected.begin() + 8))
      << "a host first asks for 8 bytes";
}

TEST_F(HidPortOnBus, HasOneHidInterfaceWithTwoEndpointsEveryMillisecond) {
  const Transfer head = bus.control(get_descriptor(0x0200, 9));
  ASSERT_EQ(head.data.size(), 9u);
  const std::uint16_t total = static_cast<std::uint16_t>(head.data[2] | head.data[3] << 8);
  const Bytes all = bus.control(get_descriptor(0x0200, 255)).data;
  ASSERT_EQ(all.size(), total);
  const Bytes report_descriptor = bus.control(kGetReportDescriptor).data;
  // Each descriptor begins with its length and type; walk through them.
  std::vector<Bytes> parts;
  for (std::size_t at = 0; at < all.size(); at += all[at]) {
    ASSERT_GE(all[at], 2u);
    ASSERT_LE(at + all[at], all.size());
    parts.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                       all.begin() + static_cast<std::ptrdiff_t>(at + all[at]));
  }
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_EQ(parts[1], (Bytes{9, 4, 0, 0, 2, 3, 0, 0, 0})) << "interface 0: HID, two endpoints, no boot protocol";
  EXPECT_EQ(parts[3], (Bytes{7, 5, kIn, 3, 64, 0, 1})) << "interrupt, 64 bytes, 1 ms";
  EXPECT_EQ(parts[4], (Bytes{7, 5, kOut, 3, 64, 0, 1}));
}

TEST_F(HidPortOnBus, GivesTheReportDescriptorThatItsHidDescriptorAnnounces) {
  ASSERT_TRUE(bus.enumerate(5));
  const Bytes hid = bus.control({0x81, 6, 0x2100, 0, 255}).data;
  ASSERT_EQ(hid.size(), 9u);
  const Bytes report = bus.control(kGetReportDescriptor).data;
  EXPECT_EQ(report.size(), static_cast<std::size_t>(hid[7] | hid[8] << 8));
  EXPECT_EQ(Bytes(report.begin(), report.begin() + 3), (Bytes{0x06, 0x00, 0xFF})) << "vendor-defined page";
  EXPECT_EQ(report.back(), 0xC0) << "end of collection";
}

TEST_F(HidPortOnBus, NamesItselfInUnicode) {
  EXPECT_EQ(bus.control(get_descriptor(0x0300, 255)).data, (Bytes{4, 3, 0x09, 0x04})) << "English";
  const std::array<std::string, 3> texts{hal::kUsbManufacturerName, hal::kUsbProductName, kSerial};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    Bytes expected{static_cast<std::uint8_t>(2 + 2 * texts[i].size()), 3};
    for (const char letter : texts[i]) expected.insert(expected.end(), {static_cast<std::uint8_t>(letter), 0});
    EXPECT_EQ(bus.control(get_descriptor(static_cast<std::uint16_t>(0x0301 + i), 255)).data, expected) << texts[i];
  }
  EXPECT_EQ(bus.control(get_descriptor(0x0304, 255)).outcome, Outcome::stalled) << "there is no fourth";
}

TEST_F(HidPortOnBus, IsConfiguredOnlyBetweenConfigurationAndReset) {
  EXPECT_FALSE(port.is_configured());
  EXPECT_FALSE(port.send(report_of(1)));
  ASSERT_TRUE(bus.enumerate(17));
  EXPECT_EQ(MockBus::address(), 17);
  EXPECT_TRUE(port.is_configured());
  EXPECT_EQ(bus.control({0x80, 8, 0, 0, 1}).data, Bytes{1}) << "get configuration";
  bus.reset();
  EXPECT_FALSE(port.is_configured());
  ASSERT_TRUE(bus.enumerate(18));
  EXPECT_TRUE(port.is_configured());
  bus.unplug();
  EXPECT_FALSE(port.is_configured());
}

TEST_F(HidPortOnBus, CarriesReportsBothWaysInOrder) {
  ASSERT_TRUE(bus.enumerate(3));
  HidReport got{};
  EXPECT_FALSE(port.receive(got));
  EXPECT_EQ(bus.in(kIn).outcome, Outcome::not_ready) << "nothing to say: NAK";
  for (std::uint8_t i = 0; i < 100; ++i) {
    ASSERT_EQ(bus.out(kOut, bytes_of(report_of(i))), Outcome::done);
    ASSERT_TRUE(port.receive(got));
    EXPECT_EQ(got, report_of(i));
    ASSERT_TRUE(port.send(report_of(static_cast<std::uint8_t>(i + 100))));
    EXPECT_EQ(bus.in(kIn).data, bytes_of(report_of(static_cast<std::uint8_t>(i + 100))));
  }
}

TEST_F(HidPortOnBus, FillsAShortReportUpWithZeros) {
  ASSERT_TRUE(bus.enumerate(3));
  ASSERT_EQ(bus.out(kOut, bytes_of(report_of(9))), Outcome::done);
  ASSERT_EQ(bus.out(kOut, {1, 2, 3}), Outcome::done);
  HidReport got{};
  ASSERT_TRUE(port.receive(got));
  ASSERT_TRUE(port.receive(got));
  HidReport expected{std::byte{1}, std::byte{2}, std::byte{3}};
  EXPECT_EQ(got, expected);
}

TEST_F(HidPortOnBus, RefusesWhatItHasNoRoomForAndLosesNothing) {
  ASSERT_TRUE(bus.enumerate(3));
  std::uint8_t sent = 0;
  while (sent < 100 && bus.out(kOut, bytes_of(report_of(sent))) == Outcome::done) ++sent;
  ASSERT_GT(sent, 1);
  ASSERT_LT(sent, 100) << "a board that does not read must eventually answer NAK";
  HidReport got{};
  for (std::uint8_t i = 0; i < sent; ++i) {
    ASSERT_TRUE(port.receive(got));
    EXPECT_EQ(got, report_of(i));
  }
  EXPECT_FALSE(port.receive(got));
  EXPECT_EQ(bus.out(kOut, bytes_of(report_of(200))), Outcome::done) << "it accepts reports again once there is room";
}

TEST_F(HidPortOnBus, TellsItsProgramWhenTheHostDoesNotFetch) {
  ASSERT_TRUE(bus.enumerate(3));
  std::uint8_t taken = 0;
  while (taken < 100 && port.send(report_of(taken))) ++taken;
  ASSERT_LT(taken, 100);
  for (std::uint8_t i = 0; i < taken; ++i) EXPECT_EQ(bus.in(kIn).data, bytes_of(report_of(i)));
  EXPECT_EQ(bus.in(kIn).outcome, Outcome::not_ready);
}

TEST_F(HidPortOnBus, ForgetsReportsOfBeforeAReset) {
  ASSERT_TRUE(bus.enumerate(3));
  ASSERT_EQ(bus.out(kOut, bytes_of(report_of(1))), Outcome::done);
  ASSERT_TRUE(port.send(report_of(2)));
  ASSERT_TRUE(bus.enumerate(4));
  HidReport got{};
  EXPECT_FALSE(port.receive(got));
  EXPECT_EQ(bus.in(kIn).outcome, Outcome::not_ready);
  ASSERT_EQ(bus.out(kOut, bytes_of(report_of(3))), Outcome::done);
  ASSERT_TRUE(port.receive(got));
  EXPECT_EQ(got, report_of(3));
}

TEST_F(HidPortOnBus, StallsWhatItDoesNotKnowAndGoesOn) {
  ASSERT_TRUE(bus.enumerate(3));
  constexpr std::array<Request, 8> unknown{{
      {0x80, 6, 0x0600, 0, 10},  // device qualifier: a full-speed device has none (USB 2.0, 9.6.2)
      {0x80, 6, 0x0F00, 0, 5},   // BOS
      {0xC0, 0x20, 0, 0, 8},     // vendor request
      {0x81, 6, 0x2300, 0, 8},   // physical descriptor
      {0xA1, 1, 0x0300, 0, 64},  // feature report: there is none
      {0x21, 9, 0x0300, 0, 64},  // likewise
      {0xA1, 3, 0, 0, 1},        // get protocol: no boot interface
      {0x81, 6, 0x2200, 7, 64},  // interface 7
  }};
  for (const Request& request : unknown)
    EXPECT_EQ(bus.control(request, Bytes(64)).outcome, Outcome::stalled)
        << std::hex << int{request.type} << " " << int{request.code} << " " << request.value;
  EXPECT_EQ(bus.control(get_descriptor(0x0100, 18)).data.size(), 18u);
  ASSERT_EQ(bus.out(kOut, bytes_of(report_of(1))), Outcome::done);
}

TEST_F(HidPortOnBus, StallsDataThatComeWithARequestWhichAsksForThem) {
  ASSERT_TRUE(bus.enumerate(3));
  ASSERT_TRUE(port.send(report_of(7)));
  constexpr std::array<Request, 9> backwards{{
      {0x00, 0, 0, 0, 2},        // status of the device
      {0x01, 0, 0, 0, 2},        // of the interface
      {0x02, 0, 0, kIn, 2},      // of an endpoint
      {0x00, 6, 0x0100, 0, 18},  // descriptor of the device
      {0x01, 6, 0x2200, 0, 64},  // of the reports
      {0x00, 8, 0, 0, 1},        // configuration
      {0x01, 10, 0, 0, 1},       // alternate setting
      {0x21, 2, 0, 0, 1},        // get idle
      {0x21, 1, 0x0100, 0, 64},  // get report
  }};
  for (const Request& request : backwards)
    EXPECT_EQ(bus.control(request, Bytes(64, 0xEE)).outcome, Outcome::stalled)
        << std::hex << int{request.type} << " " << int{request.code};
  EXPECT_EQ(bus.control({0xA1, 0x01, 0x0100, 0, 64}).data, bytes_of(report_of(7)))
      << "the report must not be overwritten";
}

TEST_F(HidPortOnBus, AnswersTheRequestsOfItsClass) {
  ASSERT_TRUE(bus.enumerate(3));
  EXPECT_EQ(bus.control({0x21, 0x0A, 0x0400, 0, 0}).outcome, Outcome::done) << "set idle";
  EXPECT_EQ(bus.control({0xA1, 0x02, 0, 0, 1}).data, Bytes{4}) << "get idle";
  ASSERT_TRUE(port.send(report_of(7)));
  EXPECT_EQ(bus.control({0xA1, 0x01, 0x0100, 0, 64}).data, bytes_of(report_of(7))) << "get report";
}

TEST_F(HidPortOnBus, ResumesWhatAHaltHeldUp) {
  ASSERT_TRUE(bus.enumerate(3));
  ASSERT_TRUE(port.send(report_of(5)));
  for (const std::uint8_t endpoint : {kIn, kOut}) {
    ASSERT_EQ(bus.control({0x02, 3, 0, endpoint, 0}).outcome, Outcome::done) << "set feature: halt";
    EXPECT_EQ(bus.control({0x82, 0, 0, endpoint, 2}).data, (Bytes{1, 0})) << "status: halted";
  }
  EXPECT_EQ(bus.in(kIn).outcome, Outcome::stalled);
  EXPECT_EQ(bus.out(kOut, Bytes(64)), Outcome::stalled);
  for (const std::uint8_t endpoint : {kIn, kOut})
    ASSERT_EQ(bus.control({0x02, 1, 0, endpoint, 0}).outcome, Outcome::done) << "clear feature: halt";
  EXPECT_EQ(bus.in(kIn).data, bytes_of(report_of(5))) << "nothing was lost";
  EXPECT_EQ(bus.out(kOut, bytes_of(report_of(6))), Outcome::done);
}

TEST_F(HidPortOnBus, IsSilentWhileSuspended) {
  ASSERT_TRUE(bus.enumerate(3));
  bus.suspend();
  EXPECT_FALSE(port.is_configured());
  EXPECT_FALSE(port.send(report_of(1)));
  bus.resume();
  EXPECT_TRUE(port.is_configured());
  EXPECT_TRUE(port.send(report_of(2)));
  EXPECT_EQ(bus.in(kIn).data, bytes_of(report_of(2)));
}

TEST_F(HidPortOnBus, OutlivesRequestsThatAreCutShort) {
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(bus.enumerate(static_cast<std::uint8_t>(20 + round)));
    for (std::uint16_t length = 1; length < 70; ++length) {
      const Transfer got = bus.control(get_descriptor(0x0200, length));
      ASSERT_EQ(got.outcome, Outcome::done) << length;
      ASSERT_EQ(got.data.size(), std::min<std::size_t>(length, 41));
    }
  }
}

/// USB 2.0, 7.1.5: a device with its own supply must not feed the bus of a host that is off.
TEST_F(HidPortOnBus, PullsItsLineUpOnlyWhileAComputersSupplyIsThere) {
  ASSERT_TRUE(bus.enumerate(7));
  ASSERT_TRUE(port.is_configured());
  port.attach(true);
  EXPECT_TRUE(MockBus::sees_device()) << "nothing changes";
  port.attach(false);
  EXPECT_FALSE(MockBus::sees_device());
  EXPECT_FALSE(port.is_configured());
  EXPECT_FALSE(port.send(report_of(1)));
  port.attach(true);
  EXPECT_TRUE(MockBus::sees_device());
  bus.reset();
  EXPECT_TRUE(bus.enumerate(8));
  EXPECT_TRUE(port.is_configured());
}

}  // namespace
