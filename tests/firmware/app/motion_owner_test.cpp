// Two clients and one board: both may read, but only one owns the motion.
#include <gtest/gtest.h>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::AxisFault;
using firmware::MessageType;
using firmware::Status;
using firmware::SupervisorState;
using firmware_test::kJog;
using firmware_test::set;
using Bench = firmware_test::BoardOnABench<float>;

constexpr std::uint16_t kFirst = 1, kSecond = 2;
constexpr auto kLost = static_cast<std::uint8_t>(AxisFault::host_heartbeat_lost);

class TwoClients : public testing::Test {
 protected:
  TwoClients() { bench.fit_and_enable_x(); }

  firmware::Message ask(std::uint16_t client, MessageType type) {
    bench.client = client;
    return bench.ask(type);
  }
  template <typename Payload>
  Status ask(std::uint16_t client, MessageType type, const Payload& payload) {
    bench.client = client;
    return bench.ask(type, payload).status;
  }
  /// Time passes while one client reads the status again and again.
  void look(std::uint16_t client, int periods) {
    for (int k = 0; k < periods; k += 20) {
      bench.run(20);
      ask(client, MessageType::status);
    }
  }
  std::uint8_t fault() { return static_cast<std::uint8_t>(bench.application.axes()[0].fault()); }
  SupervisorState state() { return bench.application.axes()[0].state(); }
  std::uint8_t flags_for(std::uint16_t client) {
    bench.client = client;
    return bench.status().flags;
  }

  Bench bench;
};

TEST_F(TwoClients, OneThatLooksKeepsNobodysMotionAlive) {
  ASSERT_EQ(ask(kFirst, MessageType::jog, kJog), Status::ok);
  look(kFirst, 1000);
  EXPECT_EQ(fault(), 0) << "the owner's own requests do";
  look(kSecond, 1000);
  EXPECT_EQ(fault(), kLost);
  EXPECT_FALSE(bench.board.axis(0).drive_enable().is_on());
}

TEST_F(TwoClients, TheOtherMayStopAndDisableAndNothingElse) {
  ASSERT_EQ(ask(kFirst, MessageType::jog, kJog), Status::ok);
  bench.run(50);
  EXPECT_EQ(ask(kSecond, MessageType::jog, kJog), Status::others_motion);
  EXPECT_EQ(ask(kSecond, MessageType::move, firmware::MoveRequest::to(0, 100)), Status::others_motion);
  EXPECT_EQ(ask(kSecond, MessageType::enable, firmware::AxesRequest{2}), Status::others_motion);
  for (const auto type : {MessageType::clear_faults, MessageType::save, MessageType::restart})
    EXPECT_EQ(ask(kSecond, type).status, Status::others_motion);
  EXPECT_NE(flags_for(kFirst) & firmware::kBoardYours, 0);
  EXPECT_NE(flags_for(kSecond) & firmware::kBoardOthers, 0);
  EXPECT_EQ(ask(kSecond, MessageType::stop).status, Status::ok);
  look(kFirst, 400);
  EXPECT_TRUE(bench.application.axes()[0].is_at_rest());
  ASSERT_EQ(ask(kFirst, MessageType::jog, kJog), Status::ok);
  bench.run(50);
  EXPECT_EQ(ask(kSecond, MessageType::disable, firmware::AxesRequest{1}), Status::ok);
  look(kFirst, 400);
  EXPECT_EQ(state(), SupervisorState::ready);
}

TEST_F(TwoClients, TakingOverIsSaidInSoManyWords) {
  ASSERT_EQ(ask(kFirst, MessageType::jog, kJog), Status::ok);
  bench.run(50);
  EXPECT_EQ(ask(kSecond, MessageType::take_over).status, Status::ok);
  EXPECT_EQ(ask(kSecond, MessageType::jog, kJog), Status::ok);
  EXPECT_EQ(ask(kFirst, MessageType::jog, kJog), Status::others_motion);
  look(kSecond, 1000);
  EXPECT_EQ(fault(), 0);
  look(kFirst, 1000);
  EXPECT_EQ(fault(), kLost) << "the former owner no longer keeps the motion alive";
}

TEST_F(TwoClients, AnAxisAtRestIsMovedByWhoeverAsks) {
  EXPECT_EQ(ask(kSecond, MessageType::jog, kJog), Status::ok);
  look(kSecond, 1000);
  EXPECT_EQ(fault(), 0);
  EXPECT_EQ(ask(kFirst, MessageType::jog, kJog), Status::others_motion);
}

TEST_F(TwoClients, AnAxisEnabledWithoutItsHostIsDropped) {
  firmware::ParameterValues values = bench.application.active();
  set(values, "host.standing_timeout", 0.5);
  bench.client = kFirst;
  ASSERT_EQ(bench.download(values).status, Status::ok);
  look(kFirst, 2000);
  EXPECT_EQ(state(), SupervisorState::enabled);
  look(kSecond, 450);
  EXPECT_EQ(state(), SupervisorState::enabled);
  look(kSecond, 150);
  EXPECT_EQ(fault(), 0) << "nothing was wrong";
  EXPECT_EQ(state(), SupervisorState::ready);
  EXPECT_FALSE(bench.board.axis(0).drive_enable().is_on());
  EXPECT_NE(bench.status().flags & firmware::kBoardLeftAlone, 0) << "why is it disabled?";
  bench.client = kFirst;
  ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
  EXPECT_EQ(bench.status().flags & firmware::kBoardLeftAlone, 0);
}

TEST_F(TwoClients, NothingIsEnabledBetweenARestartAndItsReset) {
  bench.client = kFirst;
  ASSERT_EQ(bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(200);
  ASSERT_EQ(bench.ask(MessageType::restart).status, Status::ok);
  EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::restarting);
  EXPECT_EQ(bench.ask(MessageType::jog, kJog).status, Status::restarting);
  bench.run(30);
  EXPECT_FALSE(bench.board.axis(0).drive_enable().is_on());
  EXPECT_TRUE(bench.board.wants_restart());
}

TEST_F(TwoClients, AnEnableThatHasNotBegunCountsAsEnabled) {
  bench.client = kFirst;
  ASSERT_EQ(bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(200);
  ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
  EXPECT_EQ(bench.ask(MessageType::restart).status, Status::drive_enabled);
  EXPECT_EQ(bench.ask(MessageType::save).status, Status::drive_enabled);
}

TEST_F(TwoClients, ALiveParameterDoesNotExcuseALatePeriod) {
  bench.client = kFirst;
  firmware::ParameterValues values = bench.application.active();
  set(values, "host.standing_timeout", 30);
  ASSERT_EQ(bench.download(values).status, Status::ok);
  bench.board.advance();  // a lost control period
  bench.run(1);
  EXPECT_EQ(fault(), static_cast<std::uint8_t>(AxisFault::control_overrun));
}

TEST_F(TwoClients, ACaptureIsItsClientsWhileThatOneIsHeard) {
  constexpr firmware::CaptureRequest kWanted{{1}, 1, 0};
  ASSERT_EQ(ask(kFirst, MessageType::start_capture, kWanted), Status::ok);
  look(kFirst, 3000);
  EXPECT_EQ(ask(kSecond, MessageType::start_capture, kWanted), Status::others_capture);
  EXPECT_TRUE(bench.application.capture().is_running());
  EXPECT_EQ(ask(kFirst, MessageType::start_capture, kWanted), Status::ok) << "the owner may restart its capture";
  EXPECT_EQ(ask(kSecond, MessageType::stop_capture).status, Status::others_capture);
  EXPECT_TRUE(bench.application.capture().is_running());
  look(kSecond, 2100);
  EXPECT_EQ(ask(kSecond, MessageType::stop_capture).status, Status::ok) << "the first has died";
  EXPECT_EQ(ask(kSecond, MessageType::start_capture, kWanted), Status::ok);
  look(kFirst, 2100);
  EXPECT_EQ(ask(kFirst, MessageType::start_capture, kWanted), Status::ok) << "the second has died";
  EXPECT_EQ(ask(kFirst, MessageType::stop_capture).status, Status::ok);
  EXPECT_EQ(ask(kSecond, MessageType::start_capture, kWanted), Status::ok) << "it is free at once";
}

}  // namespace
