// States, reactions and the capture of a supervised axis.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string_view>

#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "hal/axis_count.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::AxisFault;
using firmware::FaultReaction;
using firmware::SupervisorEvent;
using firmware::SupervisorState;
using firmware::boards::ValueAxis;

TEST(FaultTable, HasCauseAndRemedyForEveryFault) {
  std::set<std::string_view> names;
  for (const auto& info : firmware::kFaults) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    if (info.fault == AxisFault::none) continue;
    EXPECT_GT(std::string_view(info.cause).size(), 15u) << info.name;
    EXPECT_GE(std::string_view(info.remedy).size(), 15u) << info.name;
  }
}

/// Hosts and records identify faults by their numbers. New faults get the next numbers.
TEST(FaultTable, NumbersAreFrozen) {
  constexpr const char* kFrozen[] = {"none",
                                     "encoder_invalid",
                                     "tachometer_invalid",
                                     "control_signal_not_a_number",
                                     "dac_write_failed",
                                     "parameters_missing",
                                     "following_error",
                                     "encoder_tachometer_disagreement",
                                     "encoder_jump",
                                     "feedback_polarity",
                                     "overspeed",
                                     "travel_limit",
                                     "limit_switch_positive",
                                     "limit_switch_negative",
                                     "saturation_too_long",
                                     "drive_fault",
                                     "emergency_stop",
                                     "state_not_a_number",
                                     "control_overrun",
                                     "host_heartbeat_lost",
                                     "parameter_store_damaged",
                                     "supply_low",
                                     "reference_out_of_limits",
                                     "other_axis_stopped",
                                     "command_without_motion",
                                     "limit_cycle",
                                     "converter_not_as_set",
                                     "homing_switch_not_found",
                                     "homing_index_not_found",
                                     "homing_travel_exceeded",
                                     "amplifier_not_ready",
                                     "index_mismatch",
                                     "moved_while_starting",
                                     "homing_index_near_switch",
                                     "drive_not_off",
                                     "settings_changed"};
  int number = 0;
  for (const char* name : kFrozen) {
    const auto& info = firmware::fault_info(static_cast<AxisFault>(number));
    EXPECT_STREQ(info.name, name);
    EXPECT_EQ(static_cast<int>(info.fault), number++);
  }
}

TEST(FaultTable, SaysAfterWhichNobodyKnowsThePosition) {
  std::set<std::string_view> lost;
  for (const auto& info : firmware::kFaults)
    if (firmware::loses_position(info.fault)) lost.insert(info.name);
  EXPECT_EQ(lost, (std::set<std::string_view>{"encoder_invalid", "encoder_jump", "encoder_tachometer_disagreement",
                                              "command_without_motion", "index_mismatch"}));
}

TEST(StateTable, IsWhatTheDocumentationSays) {
  using firmware::next_state;
  const auto one = [](SupervisorEvent event) { return event | event; };
  EXPECT_EQ(next_state(SupervisorState::off, one(SupervisorEvent::enable_request), false), SupervisorState::off);
  EXPECT_EQ(next_state(SupervisorState::self_test, one(SupervisorEvent::test_passed), false), SupervisorState::ready);
  EXPECT_EQ(next_state(SupervisorState::ready, one(SupervisorEvent::enable_request), false), SupervisorState::starting);
  EXPECT_EQ(next_state(SupervisorState::starting, one(SupervisorEvent::started), false), SupervisorState::enabled);
  EXPECT_EQ(next_state(SupervisorState::enabled, one(SupervisorEvent::ramp_fault), true), SupervisorState::stopping);
  EXPECT_EQ(next_state(SupervisorState::stopping, one(SupervisorEvent::standing), false), SupervisorState::ready);
  EXPECT_EQ(next_state(SupervisorState::stopping, one(SupervisorEvent::standing), true), SupervisorState::fault);
  EXPECT_EQ(next_state(SupervisorState::fault, one(SupervisorEvent::enable_request), true), SupervisorState::fault);
  EXPECT_EQ(next_state(SupervisorState::fault, one(SupervisorEvent::clear_request), true), SupervisorState::self_test);
}

TEST(StateTable, AFaultWinsOverEveryWishInEveryState) {
  for (unsigned events = 0; events < 512; ++events) {
    const auto set = static_cast<firmware::SupervisorEvents>(events);
    if (!contains(set, SupervisorEvent::drop_fault)) continue;
    for (const auto state : {SupervisorState::self_test, SupervisorState::ready, SupervisorState::starting,
                             SupervisorState::enabled, SupervisorState::stopping})
      EXPECT_FALSE(outputs_are_on(firmware::next_state(state, set, true))) << events;
  }
}

/// Eq. (7) without friction.
struct Drive {
  const firmware_test::PaperAxis& axis;
  double x_mm = 0.0, w_rad_s = 0.0;
  void advance(double u_V) {
    x_mm += axis.Ad12 * w_rad_s + axis.Bd1 * u_V;
    w_rad_s = axis.Ad22 * w_rad_s + axis.Bd2 * u_V;
  }
};

/// Two axes whose lines the test sets.
class Board : public testing::Test {
 protected:
  Board() {
    for (std::size_t i = 0; i < 2; ++i) {
      io[i].encoder().reading = {0, true};
      io[i].tachometer().reading = {0, true};
      EXPECT_EQ(axes[i].configure(parameters(i)), firmware::Refusal::none);
    }
  }
  static firmware::AxisParameters<float> parameters(std::size_t axis) {
    auto p = firmware_test::parameters_of<float>(axis == 0 ? firmware_test::kPaperX : firmware_test::kPaperY);
    p.monitors.input_samples = 1;  // lines count at once here; input_filter_test.cpp
    return p;
  }
  void step(firmware::BoardInputs inputs = {}) {
    inputs.now_us = now += 1000;
    axes.step(inputs);
    run_drives();
  }
  void run_drives() {
    for (std::size_t i = 0; i < 2; ++i) {
      drives[i].advance(io[i].dac().code * firmware_test::kDacResolution_V);
      const double counts = std::floor(drives[i].x_mm / firmware_test::kEncoderResolution_mm);
      io[i].encoder().reading.counts = static_cast<std::uint32_t>(static_cast<std::int64_t>(counts));
      io[i].tachometer().reading.code = static_cast<std::int32_t>(std::lround(64.0 * drives[i].w_rad_s)) + offset[i];
    }
  }
  void run(int samples) {
    for (int k = 0; k < samples; ++k) step();
  }
  void enable() {
    run(firmware::kSelfTestSamples);
    for (std::size_t i = 0; i < 2; ++i) ASSERT_TRUE(axes[i].enable());
    step();
    for (std::size_t i = 0; i < 2; ++i) ASSERT_EQ(axes[i].state(), SupervisorState::enabled);
  }
  void expect_safe(std::size_t i) {
    EXPECT_FALSE(io[i].drive_enable().on);
    EXPECT_EQ(io[i].dac().code, 0);
  }

  std::array<ValueAxis, hal::kAxisCount> io;
  std::array<Drive, 2> drives{Drive{firmware_test::kPaperX}, Drive{firmware_test::kPaperY}};
  std::array<int, 2> offset{};  ///< of the tachometers, codes
  firmware::AxisGroup<float, ValueAxis, hal::kAxisCount> axes{io};
  std::uint32_t now = 0;
};

TEST_F(Board, IsReadyAfterItsSelfTestAndNotBefore) {
  run(firmware::kSelfTestSamples - 1);
  EXPECT_EQ(axes[0].state(), SupervisorState::self_test);
  EXPECT_FALSE(axes[0].enable());
  step();
  EXPECT_EQ(axes[0].state(), SupervisorState::ready);
  expect_safe(0);
}

TEST_F(Board, TheSelfTestFindsABrokenSensor) {
  offset[0] = 2000;  // 31 rad/s
  run(firmware::kSelfTestSamples);
  EXPECT_EQ(axes[0].state(), SupervisorState::fault);
  EXPECT_EQ(axes[0].fault(), AxisFault::encoder_tachometer_disagreement);
  EXPECT_EQ(axes[1].state(), SupervisorState::ready);
}

TEST_F(Board, DisableSlowsDownFirst) {
  enable();
  axes[0].jog(100.0f);
  run(300);
  ASSERT_TRUE(axes[0].disable());
  step();
  EXPECT_EQ(axes[0].state(), SupervisorState::stopping);
  EXPECT_TRUE(io[0].drive_enable().on);
  EXPECT_FALSE(axes[0].jog(50.0f)) << "no new motion while it stops";
  run(200);
  EXPECT_EQ(axes[0].state(), SupervisorState::ready);
  EXPECT_EQ(axes[0].fault(), AxisFault::none);
  expect_safe(0);
}

TEST_F(Board, AFaultThatDropsTheEnableActsInTheSameSampleAndStopsTheOtherAxisAlongARamp) {
  enable();
  for (std::size_t i = 0; i < 2; ++i) axes[i].jog(100.0f);
  run(300);
  io[0].drive_enable().faulted = true;
  step();
  EXPECT_EQ(axes[0].state(), SupervisorState::fault);
  EXPECT_EQ(axes[0].fault(), AxisFault::drive_fault);
  expect_safe(0);
  EXPECT_EQ(axes[1].state(), SupervisorState::stopping);
  EXPECT_TRUE(io[1].drive_enable().on);
  run(200);
  EXPECT_EQ(axes[1].state(), SupervisorState::fault);
  EXPECT_EQ(axes[1].fault(), AxisFault::other_axis_stopped);
  expect_safe(1);
}

TEST_F(Board, TheFirstFaultStaysUntilItIsClearedAndItsCauseGone) {
  enable();
  for (int k = 0; k < 3; ++k) step({.now_us = 0, .emergency_stop = true, .supply_low = false, .store_damaged = false});
  expect_safe(0);
  expect_safe(1);
  io[0].encoder().reading.valid = false;
  run(5);
  EXPECT_EQ(axes[0].fault(), AxisFault::emergency_stop);
  ASSERT_TRUE(axes[0].clear_fault());
  run(2);
  EXPECT_EQ(axes[0].fault(), AxisFault::encoder_invalid) << "the next cause is reported";
  io[0].encoder().reading.valid = true;
  ASSERT_TRUE(axes[0].clear_fault());
  run(firmware::kSelfTestSamples + 1);
  EXPECT_EQ(axes[0].state(), SupervisorState::ready);
}

TEST_F(Board, ADamagedStoreKeepsTheAxesFromBeingEnabled) {
  for (int k = 0; k < 60; ++k) step({.now_us = 0, .emergency_stop = false, .supply_low = false, .store_damaged = true});
  EXPECT_EQ(axes[0].fault(), AxisFault::parameter_store_damaged);
  EXPECT_FALSE(axes[0].enable());
}

TEST_F(Board, AnInterpolatorThatRunsAwayIsStoppedAlongARamp) {
  enable();
  const auto limit = motion_limits(parameters(0)).velocity;
  firmware::Increment increment = 0;
  for (int k = 0; k < 2000 && axes[0].fault() == AxisFault::none; ++k) {
    increment += limit / 500;
    axes.step_with({increment, 0}, {now += 1000, false, false, false});
    run_drives();
  }
  EXPECT_EQ(axes[0].fault(), AxisFault::reference_out_of_limits);
  EXPECT_NEAR(static_cast<double>(increment) / static_cast<double>(limit), 1.0625, 0.005);
  EXPECT_EQ(axes[0].state(), SupervisorState::stopping);
  run(400);
  EXPECT_EQ(axes[0].state(), SupervisorState::fault);
  expect_safe(0);
}

TEST_F(Board, AnotherFaultDuringAStopIsSeenAndTheWorseOneTakesOver) {
  enable();
  axes[0].jog(100.0f);
  run(300);
  axes.board().host_commands(true);
  run(102);  // nobody is heard
  ASSERT_EQ(axes[0].state(), SupervisorState::stopping);
  io[0].drive_enable().faulted = true;
  step();
  EXPECT_EQ(axes[0].state(), SupervisorState::fault);
  expect_safe(0);
  EXPECT_EQ(axes[0].fault(), AxisFault::host_heartbeat_lost) << "the first cause stays";
  EXPECT_EQ(axes[0].latched().second(), AxisFault::drive_fault);
  EXPECT_EQ(axes[1].latched().second(), AxisFault::none);
}

TEST_F(Board, OfSeveralFaultsDuringAStopTheWorstIsTheSecond) {
  enable();
  axes[0].jog(100.0f);
  run(300);
  io[1].drive_enable().faulted = true;
  run(2);
  ASSERT_EQ(axes[0].fault(), AxisFault::other_axis_stopped);
  io[0].limits().state.positive_end = true;
  step();
  EXPECT_EQ(axes[0].latched().second(), AxisFault::limit_switch_positive);
  EXPECT_EQ(axes[0].state(), SupervisorState::stopping);
  io[0].encoder().reading.valid = false;
  step();
  EXPECT_EQ(axes[0].latched().second(), AxisFault::encoder_invalid);
  run(300);
  EXPECT_EQ(axes[0].state(), SupervisorState::fault);
  io[0].encoder().reading.valid = true;
  io[0].limits().state.positive_end = false;
  ASSERT_TRUE(axes[0].clear_fault());
  EXPECT_EQ(axes[0].latched().second(), AxisFault::none);
}

TEST_F(Board, AStopWhoseSensorFailsForOneSampleEndsInAFault) {
  enable();
  axes[0].jog(100.0f);
  run(300);
  ASSERT_TRUE(axes[0].disable());
  run(5);
  io[0].encoder().reading.valid = false;
  step({.now_us = 0, .emergency_stop = false, .supply_low = false, .store_damaged = true});
  io[0].encoder().reading.valid = true;
  run(300);
  EXPECT_EQ(axes[0].state(), SupervisorState::fault) << "a stop without estimate ends as every stop does";
  expect_safe(0);
}

TEST_F(Board, AnInterpolatorsSpeedAddsToTheAxisOwn) {
  enable();
  axes[0].jog(200.0f);
  run(400);
  const auto limit = motion_limits(parameters(0)).velocity;
  firmware::Increment increment = 0;
  for (int k = 0; k < 2000 && axes[0].fault() == AxisFault::none; ++k) {
    increment += limit / 500;
    axes.step_with({increment, 0}, {now += 1000, false, false, false});
    run_drives();
  }
  EXPECT_EQ(axes[0].fault(), AxisFault::reference_out_of_limits);
  EXPECT_NEAR(static_cast<double>(increment) / static_cast<double>(limit), 1.0625 - 0.8, 0.005);
}

/// Notes when each encoder was read and each converter written.
TEST_F(Board, ReadsBothEncodersBeforeItComputesEither) {
  struct Log {
    std::string text;
  };
  struct LoggedAxis : ValueAxis {
    struct LoggedEncoder {
      Log* log = nullptr;
      hal::EncoderReading read() const {
        log->text += 'e';
        return {0, true};
      }
    };
    struct LoggedDac {
      Log* log = nullptr;
      bool write(std::int32_t) const {
        log->text += 'd';
        return true;
      }
      bool is_healthy() const { return true; }
    };
    explicit LoggedAxis(Log& log) : encoder_{&log}, dac_{&log} { tachometer().reading = {0, true}; }
    LoggedEncoder& encoder() { return encoder_; }
    LoggedDac& dac() { return dac_; }
    LoggedEncoder encoder_;
    LoggedDac dac_;
  };
  Log log;
  LoggedAxis x(log), y(log);
  firmware::AxisGroup<float, LoggedAxis, 2> group([&](std::size_t index) -> LoggedAxis& { return index == 0 ? x : y; });
  for (std::size_t i = 0; i < 2; ++i) ASSERT_EQ(group[i].configure(parameters(i)), firmware::Refusal::none);
  log.text.clear();
  group.step({});
  EXPECT_EQ(log.text, "eedd");
}

TEST_F(Board, TheCaptureHoldsTheTenthOfASecondBeforeTheFault) {
  enable();
  axes[0].jog(50.0f);
  run(500);
  const auto last = axes[0].telemetry().encoder_counts;
  io[0].drive_enable().faulted = true;
  step();
  const auto& capture = axes[0].capture();
  EXPECT_TRUE(capture.is_frozen());
  ASSERT_EQ(capture.size(), firmware::kCaptureRows);
  EXPECT_GT(capture.row(100).estimate.anchor_counts, last);
  for (std::size_t i = 0; i + 1 < capture.size(); ++i)  // 50 mm/s: 20.48 counts a sample
    EXPECT_NEAR(static_cast<double>(capture.row(i + 1).estimate.anchor_counts - capture.row(i).estimate.anchor_counts),
                20.5, 1.0);
  run(50);
  EXPECT_GT(capture.row(100).estimate.anchor_counts, last) << "later samples do not enter";
}

TEST_F(Board, LimitingIsNoFault) {
  enable();
  axes[0].jog(1000.0f);
  run(500);
  EXPECT_TRUE(axes[0].limiting().velocity_limited);
  EXPECT_EQ(axes[0].fault(), AxisFault::none);
  axes[0].jog(10.0f);
  run(1);
  EXPECT_FALSE(axes[0].limiting().velocity_limited);
}

}  // namespace
