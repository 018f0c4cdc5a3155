// Excitations of an axis in closed loop, requested by a host.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::ExcitationEnd;
using firmware::ExcitationInput;
using firmware::ExcitationKind;
using firmware::ExcitationPhase;
using firmware::MessageType;
using firmware::Status;
using firmware::SupervisorState;

class ExcitedLoop : public testing::Test {
 protected:
  ExcitedLoop() { bench.fit_and_enable_x(); }

  static firmware::ExcitationRequest request(ExcitationKind kind, ExcitationInput input) {
    firmware::ExcitationRequest r;
    r.kind = static_cast<std::uint8_t>(kind);
    r.input = static_cast<std::uint8_t>(input);
    r.travel_counts = 8000;
    r.speed = 60;  // counts a sample: 146 mm/s
    r.drive_velocity = 92;
    r.volts = 2000;
    r.samples = 2000;
    r.fade_samples = 100;
    return r;
  }
  void load(std::initializer_list<firmware::ExcitationEntriesRequest::Entry> entries, ExcitationInput input) {
    firmware::ExcitationEntriesRequest part;
    part.input = static_cast<std::uint8_t>(input);
    part.count = static_cast<std::uint8_t>(entries.size());
    std::ranges::copy(entries, part.entry.begin());
    ASSERT_EQ(bench.ask(MessageType::load_excitation, part).status, Status::ok);
  }
  firmware::ExcitationStatePayload state() {
    firmware::ExcitationStatePayload payload;
    EXPECT_TRUE(bench.ask(MessageType::excitation_state).get(payload));
    return payload;
  }
  /// Runs to the end with a live host; returns the largest distance and reference speed.
  void run_to_the_end() {
    for (int k = 0; k < 400 && state().phase != static_cast<std::uint8_t>(ExcitationPhase::done); ++k) {
      for (int i = 0; i < 20; ++i) {
        bench.run(1);
        const auto& seen = bench.application.axes()[0].telemetry();
        farthest = std::max(farthest, std::abs(static_cast<double>(seen.encoder_counts)));
        largest_V = std::max(largest_V, std::abs(static_cast<double>(seen.control_V)));
      }
    }
    EXPECT_EQ(static_cast<ExcitationEnd>(state().end), ExcitationEnd::completed);
    EXPECT_EQ(bench.application.axes()[0].state(), SupervisorState::enabled);
    EXPECT_TRUE(bench.application.axes()[0].is_at_rest());
  }
  firmware_test::BoardOnABench<float> bench;
  double farthest = 0.0, largest_V = 0.0;
};

TEST_F(ExcitedLoop, TrianglesOfTheReferenceGoThereAndBack) {
  firmware::ExcitationRequest r = request(ExcitationKind::triangle, ExcitationInput::reference);
  r.amplitude = 40;
  r.step = r.last_step = 1u << 24;
  ASSERT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::ok);
  run_to_the_end();
  EXPECT_NEAR(farthest, 40.0, 4.0) << "counts";
  EXPECT_NEAR(static_cast<double>(bench.application.axes()[0].telemetry().reference.counts), 0.0, 1.0);
}

TEST_F(ExcitedLoop, LinesAtTheControllersOutputLeaveTheAxisWhereItWas) {
  load({{300, 5u * 4294967u, 0}, {300, 31u * 4294967u, 1u << 30}}, ExcitationInput::output);
  firmware::ExcitationRequest r = request(ExcitationKind::multisine, ExcitationInput::output);
  r.count = 2;
  r.amplitude = 600;
  r.period = r.fade_samples = 1000;
  ASSERT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::ok);
  run_to_the_end();
  EXPECT_GT(largest_V, 0.08) << "600 steps of the converter are 0.18 V";
  EXPECT_LT(std::abs(static_cast<double>(bench.application.axes()[0].telemetry().encoder_counts)), 30.0);
}

TEST_F(ExcitedLoop, ALadderTurnsRoundWithinItsWindow) {
  load({{10, 400, 0}, {-10, 400, 0}, {40, 400, 0}, {-40, 400, 0}}, ExcitationInput::jog);
  firmware::ExcitationRequest r = request(ExcitationKind::train, ExcitationInput::jog);
  r.count = 4;
  r.amplitude = 40;
  r.margin_counts = 2500;  // the way of a stop from 98 mm/s
  ASSERT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::ok);
  run_to_the_end();
  EXPECT_GT(farthest, 3000.0);
  EXPECT_LT(farthest, 8000.0);
}

TEST_F(ExcitedLoop, NobodyElseMovesTheAxisMeanwhile) {
  firmware::ExcitationRequest r = request(ExcitationKind::triangle, ExcitationInput::reference);
  r.amplitude = 40;
  r.step = r.last_step = 1u << 24;
  ASSERT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::ok);
  bench.run(20);
  EXPECT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::wrong_state);
  EXPECT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 5.0F}).status, Status::wrong_state);
  EXPECT_EQ(bench.ask(MessageType::save).status, Status::drive_enabled);
  bench.client = 2;
  EXPECT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::others_motion);
  EXPECT_EQ(bench.ask(MessageType::stop_excitation).status, Status::ok) << "every client may stop";
  bench.client = 1;
  for (int k = 0; k < 50; ++k) {
    bench.run(10);
    state();
  }
  EXPECT_EQ(static_cast<ExcitationEnd>(state().end), ExcitationEnd::asked);
  EXPECT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 5.0F}).status, Status::ok);
}

TEST_F(ExcitedLoop, ASilentHostEndsIt) {
  firmware::ExcitationRequest r = request(ExcitationKind::triangle, ExcitationInput::reference);
  r.amplitude = 40;
  r.step = r.last_step = 1u << 24;
  ASSERT_EQ(bench.ask(MessageType::start_excitation, r).status, Status::ok);
  bench.run(1000);
  EXPECT_EQ(bench.application.axes()[0].fault(), firmware::AxisFault::host_heartbeat_lost);
  EXPECT_FALSE(bench.board.axis(0).drive_enable().is_on());
  EXPECT_EQ(static_cast<ExcitationEnd>(state().end), ExcitationEnd::fault);
}

}  // namespace
