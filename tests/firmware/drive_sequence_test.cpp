// Amplifier and brake between a request and motion, and between standstill and zero current.
#include "firmware/core/supervision/drive_sequence.hpp"

#include <vector>

#include "tests/firmware/driven_axis.hpp"

namespace {

using firmware::AxisFault;
using firmware::SupervisorState;
using firmware_test::DrivenAxis;

constexpr int kWait = 50, kRelease = 20, kApply = 30;

/// Enabled one period ago.
class Sequence : public testing::Test {
 protected:
  static firmware::AxisParameters<float> parameters(bool ready_input, bool brake) {
    auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
    p.sequence = {.ready_input = ready_input,
                  .brake_fitted = brake,
                  .amplifier_wait = kWait,
                  .brake_release = kRelease,
                  .brake_application = kApply};
    p.monitors.input_samples = 1;
    return p;
  }
  static void run(DrivenAxis& axis, int periods) {
    for (int k = 0; k < periods; ++k) axis.step();
  }
  static bool is_closed(const DrivenAxis& axis) { return axis.axis.telemetry().enabled; }
  static firmware::boards::ValueAxis::Enable& lines(DrivenAxis& axis) { return axis.io.drive_enable(); }
  static void run_until_enabled(DrivenAxis& axis) {
    run(axis, kWait + kRelease + 5);
    ASSERT_EQ(axis.axis.state(), SupervisorState::enabled);
  }
};

TEST_F(Sequence, TheLoopClosesWhenTheAmplifierIsReadyAndMotionWaitsForTheBrake) {
  DrivenAxis axis(parameters(true, true));
  lines(axis).ready = false;
  run(axis, kWait / 2);
  EXPECT_EQ(axis.axis.state(), SupervisorState::starting);
  EXPECT_TRUE(lines(axis).on) << "what does it wait for?";
  EXPECT_FALSE(is_closed(axis));
  EXPECT_FALSE(lines(axis).brake_released) << "nothing would hold the axis";
  EXPECT_EQ(axis.io.dac().code, 0);
  lines(axis).ready = true;
  run(axis, 1);
  EXPECT_TRUE(is_closed(axis));
  EXPECT_TRUE(lines(axis).brake_released);
  for (int k = 0; k < kRelease; ++k) {
    EXPECT_FALSE(axis.axis.jog(10.0f)) << "the brake still holds, after " << k;
    run(axis, 1);
  }
  run(axis, 1);
  EXPECT_EQ(axis.axis.state(), SupervisorState::enabled);
  EXPECT_TRUE(axis.axis.jog(10.0f));
}

TEST_F(Sequence, WithoutTheReadyInputTheDelayPassesFirst) {
  DrivenAxis axis(parameters(false, false));
  lines(axis).ready = false;  // not wired
  run(axis, kWait);
  EXPECT_FALSE(is_closed(axis));
  run(axis, 2);
  EXPECT_TRUE(is_closed(axis));
  run_until_enabled(axis);
  EXPECT_FALSE(lines(axis).brake_released) << "none is fitted";
}

TEST_F(Sequence, AnAmplifierThatNeverBecomesReadyIsAFault) {
  DrivenAxis axis(parameters(true, true));
  lines(axis).ready = false;
  run(axis, kWait + 2);
  EXPECT_EQ(axis.axis.fault(), AxisFault::amplifier_not_ready);
  EXPECT_EQ(axis.axis.state(), SupervisorState::fault);
  EXPECT_FALSE(lines(axis).on);
  EXPECT_FALSE(is_closed(axis));
}

/// A converter stuck at 10 V, and an amplifier with an offset, drive the axis while nothing holds it.
TEST_F(Sequence, AnAxisThatMovesBeforeTheLoopClosesIsLetGoWithinAFewCounts) {
  for (const double offset_V : {10.0, -10.0, 0.4, 0.01}) {
    auto p = parameters(false, false);
    p.sequence.amplifier_wait = 10'000;
    DrivenAxis axis(p);
    axis.amplifier_offset_V = offset_V;
    for (int k = 0; k < 12'000 && axis.axis.state() == SupervisorState::starting; ++k) run(axis, 1);
    EXPECT_EQ(axis.axis.fault(), AxisFault::moved_while_starting) << offset_V;
    EXPECT_FALSE(lines(axis).on);
    EXPECT_LT(std::abs(axis.at_mm()), std::abs(offset_V) > 1.0 ? 0.1 : 0.03) << offset_V;
  }
}

TEST_F(Sequence, AnAxisThatTremblesByACountStarts) {
  DrivenAxis axis(parameters(false, false));
  for (int k = 0; k < kWait + 2; ++k) {
    axis.io.encoder().reading.counts += k % 2 == 0 ? 1u : -1u;
    axis.axis.step();
  }
  EXPECT_EQ(axis.axis.state(), SupervisorState::enabled);
}

TEST_F(Sequence, AStopBeforeTheLoopClosesDropsTheEnableAtOnce) {
  DrivenAxis axis(parameters(false, true));
  run(axis, kWait / 2);
  ASSERT_TRUE(axis.axis.disable());
  run(axis, 1);
  EXPECT_EQ(axis.axis.state(), SupervisorState::ready);
  EXPECT_FALSE(lines(axis).on);
  DrivenAxis other(parameters(false, true));
  run(other, kWait / 2);
  other.step(AxisFault::other_axis_stopped);
  EXPECT_EQ(other.axis.state(), SupervisorState::fault);
  EXPECT_FALSE(lines(other).on);
}

TEST_F(Sequence, TheBrakeHoldsBeforeTheEnableDrops) {
  DrivenAxis axis(parameters(true, true));
  run_until_enabled(axis);
  ASSERT_TRUE(axis.axis.jog(50.0f));
  run(axis, 200);
  ASSERT_TRUE(axis.axis.disable());
  int moving_under_brake = 0, held_by_both = 0;
  for (int k = 0; k < 1000 && lines(axis).on; ++k) {
    const double before = axis.at_mm();
    run(axis, 1);
    const bool moves = std::abs(axis.at_mm() - before) > 0.001;  // 1 mm/s
    if (lines(axis).on && !lines(axis).brake_released) (moves ? moving_under_brake : held_by_both)++;
  }
  EXPECT_EQ(moving_under_brake, 0);
  EXPECT_GE(held_by_both, kApply - 1);
  EXPECT_LE(held_by_both, kApply + 2);
  EXPECT_EQ(axis.axis.state(), SupervisorState::ready);
  EXPECT_FALSE(lines(axis).on);
}

TEST_F(Sequence, AFaultThatDropsTheEnableAppliesTheBrakeInTheSamePeriod) {
  DrivenAxis axis(parameters(true, true));
  run_until_enabled(axis);
  lines(axis).faulted = true;
  run(axis, 1);
  EXPECT_FALSE(lines(axis).on);
  EXPECT_FALSE(lines(axis).brake_released);
}

TEST_F(Sequence, AnAmplifierThatStaysReadyAfterTheDropHasItsPowerCut) {
  DrivenAxis axis(parameters(true, false));
  run_until_enabled(axis);
  lines(axis).ready_stuck = true;
  ASSERT_TRUE(axis.axis.disable());
  run(axis, 60);
  ASSERT_FALSE(lines(axis).on);
  EXPECT_FALSE(axis.axis.must_cut_power()) << "a contact takes a while";
  EXPECT_FALSE(axis.axis.may_be_enabled()) << "the contact cannot tell when the amplifier drives";
  run(axis, 100);
  EXPECT_EQ(axis.axis.fault(), AxisFault::drive_not_off);
  EXPECT_TRUE(axis.axis.must_cut_power());
  ASSERT_TRUE(axis.axis.clear_fault());
  EXPECT_FALSE(axis.axis.must_cut_power());
}

TEST_F(Sequence, AnAmplifierThatOpensItsContactInTimeIsBelieved) {
  DrivenAxis axis(parameters(true, false));
  run_until_enabled(axis);
  ASSERT_TRUE(axis.axis.disable());
  int closed = 0;
  for (int k = 0; k < 300; ++k) {
    run(axis, 1);
    lines(axis).ready_stuck = !lines(axis).on && ++closed < 90;
  }
  EXPECT_EQ(axis.axis.state(), SupervisorState::ready);
  EXPECT_TRUE(axis.axis.may_be_enabled());
}

TEST_F(Sequence, AnAmplifierThatIsReadyWithoutAnEnableOrDrivesTheAxisHasItsPowerCut) {
  for (const bool by_contact : {true, false}) {
    DrivenAxis axis(parameters(by_contact, false));
    run_until_enabled(axis);
    ASSERT_TRUE(axis.axis.disable());
    run(axis, 1000);
    ASSERT_EQ(axis.axis.state(), SupervisorState::ready);
    lines(axis).ready_stuck = by_contact;
    axis.stuck_V = by_contact ? 0.0 : 3.0;
    for (int k = 0; k < 5000 && axis.axis.state() == SupervisorState::ready; ++k) run(axis, 1);
    EXPECT_EQ(axis.axis.fault(), AxisFault::drive_not_off) << by_contact;
    EXPECT_TRUE(axis.axis.must_cut_power());
  }
}

/// A welded enable with a converter that is stuck.
TEST_F(Sequence, AnAxisThatGainsSpeedAfterTheDropHasItsPowerCut) {
  DrivenAxis axis(parameters(false, false));
  run_until_enabled(axis);
  axis.stuck_V = 2.0;
  lines(axis).faulted = true;
  run(axis, 60);
  EXPECT_EQ(axis.axis.fault(), AxisFault::drive_fault);
  EXPECT_TRUE(axis.axis.must_cut_power());
}

/// The monitor alone, at 1 kHz; speeds in multiples of the allowed increase.
class DropWatch : public testing::Test {
 protected:
  explicit DropWatch(int brake = 0) {
    auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
    p.sequence = {.brake_fitted = brake > 0, .brake_application = brake};
    limits_ = p.monitors;
    gain_ = 2.0f * limits_.disagreement_floor;
    over_ = limits_.overspeed / gain_;
    watch_.configure(p);
    watch_.begin();
  }
  /// Whether it detects within this many samples that the axis is driven.
  template <typename Speed>
  bool finds(int samples, Speed speed) {
    bool found = false;
    for (int k = 0; k < samples; ++k) found = watch_.is_driven(limits_, false, gain_ * speed(k)) || found;
    return found;
  }
  firmware::MonitorLimits<float> limits_;
  float gain_ = 0.0f, over_ = 0.0f;
  firmware::DropWatch<float> watch_;
};
class DropWatchWithBrake : public DropWatch {
 protected:
  DropWatchWithBrake() : DropWatch(50) {}
};

TEST_F(DropWatch, NoiseOnTheEncoderIsNoMotion) {
  EXPECT_FALSE(finds(500, [](int k) { return k < 20 ? 0.0f : k % 2 == 0 ? 1.9f : -1.9f; }));
}

TEST_F(DropWatch, AnAxisThatCoastsIsNotDrivenAndOneThatGainsIs) {
  EXPECT_FALSE(finds(90, [](int k) { return 3.0f - 0.01f * static_cast<float>(k); }));
  watch_.begin();
  EXPECT_FALSE(finds(20, [](int k) { return 1.0f + 0.04f * static_cast<float>(k); }));
  EXPECT_TRUE(finds(20, [](int k) { return 1.8f + 0.04f * static_cast<float>(k); }));
}

TEST_F(DropWatch, AnAxisMovedByHandIsNotDrivenAndOneBeyondItsLimitIs) {
  finds(200, [](int) { return 0.0f; });
  EXPECT_FALSE(finds(200, [this](int) { return 0.9f * over_; }));
  EXPECT_TRUE(finds(100, [this](int) { return -1.1f * over_; }));
}

TEST_F(DropWatchWithBrake, AnAxisMayFallUntilItHolds) {
  EXPECT_FALSE(finds(140, [](int k) { return k < 45 ? 0.05f * static_cast<float>(k) : 2.0f; }));
  watch_.begin();
  EXPECT_TRUE(finds(140, [](int k) { return 0.05f * static_cast<float>(k); }));
}

TEST_F(Sequence, AnAmplifierThatIsReadyNoLongerIsAFault) {
  DrivenAxis axis(parameters(true, true));
  run_until_enabled(axis);
  lines(axis).ready = false;
  run(axis, 1);
  EXPECT_EQ(axis.axis.fault(), AxisFault::amplifier_not_ready);
  EXPECT_FALSE(lines(axis).on);
}

TEST_F(Sequence, AWishToStopWhileItStartsIsObeyed) {
  for (const int after : {5, kWait + 10}) {  // the loop open, the brake on its way
    DrivenAxis axis(parameters(false, true));
    run(axis, after);
    ASSERT_EQ(axis.axis.state(), SupervisorState::starting);
    EXPECT_TRUE(axis.axis.disable());
    run(axis, kApply + 60);
    EXPECT_EQ(axis.axis.state(), SupervisorState::ready) << after;
    EXPECT_FALSE(lines(axis).on);
    EXPECT_FALSE(lines(axis).brake_released);
  }
}

/// Rest before the loop closed, at this very place, says nothing about the axis after it has opened.
TEST_F(Sequence, AnAxisStandsOnlyOnceItHasBeenSeenAtRestWithoutItsLoop) {
  DrivenAxis axis(parameters(false, false));
  run_until_enabled(axis);
  ASSERT_TRUE(axis.axis.disable());
  while (axis.axis.state() != SupervisorState::ready) run(axis, 1);
  for (int k = 0; k < firmware::Standstill::kSamples; ++k) {
    EXPECT_FALSE(axis.axis.enable()) << k;
    run(axis, 1);
  }
  EXPECT_TRUE(axis.axis.enable());
}

TEST_F(Sequence, AReadyInputWithoutATimeIsRefused) {
  auto p = parameters(true, false);
  p.sequence.amplifier_wait = 0;
  firmware::boards::ValueAxis io;
  firmware::SupervisedAxis<float, firmware::boards::ValueAxis> axis(io);
  EXPECT_EQ(axis.configure(p), firmware::Refusal::amplifier_ready);
}

/// Runs whenever it is enabled.
struct ControlInterrupt {
  ControlInterrupt() = default;
  ControlInterrupt(const ControlInterrupt&) = delete;
  ControlInterrupt& operator=(const ControlInterrupt&) = delete;
  ~ControlInterrupt() {
    axis->axis.step();
    seen.push_back(axis->axis.telemetry().encoder_counts);
  }
  static inline DrivenAxis* axis = nullptr;
  static inline std::vector<std::int64_t> seen;
};

/// Catches a control law that computes with a mixture of old and new parameters.
TEST_F(Sequence, AnAxisStandsAsideWhileItTakesParameters) {
  DrivenAxis axis(parameters(false, false));
  EXPECT_TRUE(axis.axis.disable());
  for (int k = 0; k < 200; ++k) axis.step();
  ASSERT_EQ(axis.axis.state(), SupervisorState::ready);
  const std::int64_t before = axis.axis.telemetry().encoder_counts;
  axis.io.encoder().reading.counts += 3;
  ControlInterrupt::axis = &axis;
  EXPECT_EQ(axis.axis.configure<ControlInterrupt>(parameters(false, true)), firmware::Refusal::none);
  EXPECT_EQ(ControlInterrupt::seen, (std::vector<std::int64_t>{before, before + 3})) << "nothing, then a step";
  EXPECT_EQ(axis.axis.state(), SupervisorState::self_test);
  for (int k = 0; k < firmware::kSelfTestSamples + 1; ++k) axis.axis.step();
  EXPECT_EQ(axis.axis.state(), SupervisorState::ready);
}

}  // namespace
