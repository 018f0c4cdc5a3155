// Noise spikes and bouncing contacts cause no fault; persistent signals do.
#include "firmware/core/supervision/input_filter.hpp"

#include <functional>

#include "tests/firmware/driven_axis.hpp"

namespace {

using firmware::AxisFault;
using firmware_test::DrivenAxis;

TEST(InputFilter, WaitsTwoMillisecondsAndTwoPeriodsAtLeast) {
  EXPECT_EQ(firmware::input_samples(0.001f), 3);
  EXPECT_EQ(firmware::input_samples(1.0f / 20'000), 41);
  EXPECT_EQ(firmware::input_samples(1.0f / 250), 2) << "a single reading proves nothing";
}

TEST(InputFilter, CountsPeriodsInARow) {
  firmware::InputFilter filter;
  filter.configure(3);
  for (int spark = 0; spark < 50; ++spark) {
    EXPECT_FALSE(filter.filtered(true));
    EXPECT_FALSE(filter.filtered(true));
    EXPECT_FALSE(filter.filtered(false));
    EXPECT_FALSE(filter.is_pending());
  }
  filter.filtered(true);
  filter.filtered(true);
  EXPECT_TRUE(filter.filtered(true));
  EXPECT_TRUE(filter.filtered(true)) << "and stays";
  EXPECT_FALSE(filter.filtered(false)) << "released at once";
}

TEST(InputFilter, IsNotBegunAnewByAChangeOfParameters) {
  firmware::InputFilter filter;
  filter.configure(3);
  filter.filtered(true);
  filter.filtered(true);
  filter.configure(3);
  EXPECT_TRUE(filter.filtered(true));
  filter.configure(4);
  EXPECT_TRUE(filter.filtered(true)) << "active in four periods by now";
}

struct Line {
  const char* name;
  std::function<void(firmware::boards::ValueAxis&, bool)> set;
  AxisFault fault;
};

TEST(AxisInputs, SparksTripNothingAndWhatStaysDoes) {
  const Line lines[] = {
      {"positive end", [](auto& io, bool on) { io.limits().state.positive_end = on; },
       AxisFault::limit_switch_positive},
      {"drive fault", [](auto& io, bool on) { io.drive_enable().faulted = on; }, AxisFault::drive_fault},
      {"encoder's receivers", [](auto& io, bool on) { io.encoder().faulted = on; }, AxisFault::encoder_invalid},
      {"not ready", [](auto& io, bool on) { io.drive_enable().ready = !on; }, AxisFault::amplifier_not_ready},
  };
  for (const Line& line : lines) {
    auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
    // Of the optional inputs, only the tested one is wired.
    p.sequence.ready_input = line.fault == AxisFault::amplifier_not_ready;
    p.sequence.amplifier_wait = p.sequence.ready_input ? 10 : 0;
    p.encoder_fault_input = line.fault == AxisFault::encoder_invalid;
    DrivenAxis axis(p);
    axis.step();
    axis.step();
    ASSERT_TRUE(axis.axis.jog(50.0f)) << line.name;
    for (int k = 0; k < 1000; ++k) {
      line.set(axis.io, k % 5 < 2);
      axis.step();
    }
    EXPECT_EQ(axis.axis.fault(), AxisFault::none) << line.name;
    line.set(axis.io, true);
    for (int k = 0; k < 3; ++k) axis.step();
    EXPECT_EQ(axis.axis.fault(), line.fault) << line.name;
  }
}

/// Travel of the axis while the control interrupt is missing.
TEST(LostPeriods, EndInAStopAlongTheRamp) {
  DrivenAxis axis(firmware_test::parameters_of<float>(firmware_test::kPaperX));
  ASSERT_TRUE(axis.axis.jog(250.0f));
  for (int k = 0; k < 600; ++k) axis.step();
  axis.run_on(5);  // 1.25 mm
  const double begin = axis.at_mm();
  axis.axis.bridge_gap(axis.io.encoder().reading);
  axis.step(AxisFault::control_overrun);
  EXPECT_EQ(axis.axis.state(), firmware::SupervisorState::stopping);
  for (int k = 0; k < 1000; ++k) axis.step();
  EXPECT_EQ(axis.axis.fault(), AxisFault::control_overrun);
  EXPECT_EQ(axis.axis.latched().second(), AxisFault::none) << "no fault of the feedback is reported";
  EXPECT_LT(axis.at_mm() - begin, 250.0 * (0.125 + 0.04) / 2 + 1.0) << "the ramp's own way";
  EXPECT_NEAR(static_cast<double>(axis.axis.telemetry().encoder_counts) * firmware_test::kEncoderResolution_mm,
              axis.at_mm(), 0.01)
      << "no count is lost";
}

}  // namespace
