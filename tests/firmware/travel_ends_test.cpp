// Motion stays inside the limits of travel: jogs stop, moves are refused; enabling is all or nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/core/fixed_units.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "tests/firmware/driven_axis.hpp"

namespace {

using firmware::AxisFault;
using firmware::CountPosition;
using firmware::SupervisorState;
using firmware::boards::ValueAxis;
using firmware_test::DrivenAxis;

firmware::AxisParameters<float> parameters(double travel_max_mm, float acceleration = 2000.0f, float jerk = 50000.0f) {
  auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
  p.monitors.travel_max_counts = std::llround(travel_max_mm / firmware_test::kEncoderResolution_mm);
  p.monitors.travel_min_counts = -p.monitors.travel_max_counts;
  p.acceleration_limit = acceleration;
  p.jerk_limit = jerk;
  return p;
}

struct Jog {
  float speed, acceleration, jerk;
};

class JogToTheEnd : public testing::TestWithParam<Jog> {};
INSTANTIATE_TEST_SUITE_P(Limits, JogToTheEnd,
                         testing::Values(Jog{250.0f, 2000.0f, 50000.0f}, Jog{250.0f, 100.0f, 50000.0f},
                                         Jog{10.0f, 2000.0f, 50000.0f}, Jog{100.0f, 2000.0f, 20000.0f},
                                         Jog{250.0f, 2000.0f, 1e6f}));

TEST_P(JogToTheEnd, StandsInsideAndNotFarFromIt) {
  const Jog& jog = GetParam();
  constexpr double kEnd_mm = 100.0;
  for (const int start : {1, 60}) {  // from standstill, and retargeted while it accelerates
    DrivenAxis axis(parameters(kEnd_mm, jog.acceleration, jog.jerk));
    ASSERT_TRUE(axis.axis.jog(jog.speed / static_cast<float>(start)));
    for (int k = 0; k < start; ++k) axis.step();
    ASSERT_TRUE(axis.axis.jog(jog.speed));
    for (int k = 0; k < 60'000; ++k) axis.step();
    EXPECT_EQ(axis.axis.fault(), AxisFault::none);
    EXPECT_TRUE(axis.axis.is_at_rest());
    EXPECT_LT(axis.at_mm(), kEnd_mm);
    EXPECT_GT(axis.at_mm(), kEnd_mm - 2.0 - 0.05 * static_cast<double>(jog.speed)) << "it stops far too early";
  }
}

TEST(EndsOfTravel, FromTheEndAJogLeadsBackOnly) {
  DrivenAxis axis(parameters(10.0));
  ASSERT_TRUE(axis.axis.jog(50.0f));
  for (int k = 0; k < 2000; ++k) axis.step();
  for (int again = 0; again < 20; ++again) {
    axis.axis.jog(50.0f);
    for (int k = 0; k < 100; ++k) axis.step();
  }
  EXPECT_LT(axis.at_mm(), 10.0) << "repeated requests move the axis out";
  EXPECT_EQ(axis.axis.fault(), AxisFault::none);
  EXPECT_TRUE(axis.axis.jog(-50.0f));
}

TEST(EndsOfTravel, AMoveBeyondIsRefusedBeforeItStarts) {
  DrivenAxis axis(parameters(10.0));
  const auto target = [](double mm) {
    return CountPosition::at(std::llround(mm / firmware_test::kEncoderResolution_mm));
  };
  EXPECT_EQ(axis.axis.plan_move_to(target(50.0)).refusal, firmware::Refusal::outside_travel);
  EXPECT_EQ(axis.axis.plan_move_to(target(-10.1)).refusal, firmware::Refusal::outside_travel);
  EXPECT_EQ(axis.axis.plan_move_to(target(9.9)).refusal, firmware::Refusal::none);
}

/// The limits are 20 mm apart.
TEST(EndsOfTravel, AnAxisThatIsNotHomedGoesAsFarAsItsTravelIsLongFromWhereItWasEnabled) {
  DrivenAxis axis(parameters(10.0));
  const auto run = [&axis](int samples) {
    for (int k = 0; k < samples; ++k) axis.step();
  };
  const auto by = [](double mm) {
    return static_cast<std::int64_t>(std::llround(mm / firmware_test::kEncoderResolution_mm));
  };
  const auto enable_anew = [&] {
    ASSERT_TRUE(axis.axis.disable());
    run(300);
    ASSERT_TRUE(axis.axis.enable());
    run(2);
  };
  ASSERT_TRUE(axis.axis.disable());
  run(300);
  axis.axis.forget_home();
  run(1);
  double from_mm = axis.at_mm();
  ASSERT_TRUE(axis.axis.enable());
  run(2);
  for (const float way : {1.0f, -1.0f}) {
    ASSERT_TRUE(axis.axis.jog(50.0f * way)) << way;
    run(3000);
    const double went_mm = static_cast<double>(way) * (axis.at_mm() - from_mm);
    EXPECT_TRUE(axis.axis.is_at_rest());
    EXPECT_LT(went_mm, 20.0) << way;
    EXPECT_GT(went_mm, 15.0) << "it stops far too early";
    EXPECT_EQ(axis.axis.plan_move_by(by(static_cast<double>(way) * (20.1 - went_mm))).refusal,
              firmware::Refusal::outside_travel)
        << "several moves must not go farther than one";
    ASSERT_TRUE(axis.axis.start(axis.axis.plan_move_by(by(static_cast<double>(-way) * went_mm)).plan));
    run(2000);
    EXPECT_NEAR(axis.at_mm(), from_mm, 0.1) << "moving back is allowed";
  }
  ASSERT_TRUE(axis.axis.jog(50.0f));
  run(3000);
  from_mm = axis.at_mm();
  enable_anew();
  ASSERT_TRUE(axis.axis.jog(50.0f)) << "the travel counts from this position";
  run(3000);
  EXPECT_NEAR(axis.at_mm() - from_mm, 20.0, 5.0);
  EXPECT_EQ(axis.axis.fault(), AxisFault::none);
}

class TwoAxes : public testing::Test {
 protected:
  TwoAxes() {
    for (std::size_t i = 0; i < 2; ++i) {
      io[i].encoder().reading = {0, true};
      io[i].tachometer().reading = {0, true};
      EXPECT_EQ(axes[i].configure(parameters(1000.0)), firmware::Refusal::none);
    }
    run(firmware::kSelfTestSamples + 1);
  }
  void run(int samples) {
    for (int k = 0; k < samples; ++k) axes.step({now += 1000, false, false, false});
  }
  std::array<ValueAxis, 2> io;
  firmware::AxisGroup<float, ValueAxis, 2> axes{io};
  std::uint32_t now = 0;
};

TEST_F(TwoAxes, AreEnabledTogetherOrNotAtAll) {
  io[1].drive_enable().faulted = true;
  run(3);
  EXPECT_EQ(axes.enable(3), 1u) << "the second refuses";
  run(2);
  EXPECT_EQ(axes[0].state(), SupervisorState::ready);
  EXPECT_EQ(axes.enable(1), 2u);
  run(1);
  EXPECT_EQ(axes[0].state(), SupervisorState::enabled);
}

TEST_F(TwoAxes, AreNotEnabledWhileTheyMove) {
  for (int k = 0; k < 40; ++k) {
    io[0].encoder().reading.counts += 10;  // 24 mm/s
    io[0].tachometer().reading.code = 64 * 15;
    run(1);
  }
  EXPECT_EQ(axes.enable(3), 0u);
  io[0].tachometer().reading.code = 0;
  run(40);
  EXPECT_EQ(axes.enable(3), 2u);
}

/// Limits as increments against double precision: at every rate, in float and in fixed point.
TEST(MotionLimits, AreKeptToAHundredthAtEveryRate) {
  int accepted = 0;
  for (const double rate_Hz : {250.0, 1000.0, 4000.0, 10'000.0, 20'000.0}) {
    for (const double jerk : {0.1, 5.0, 500.0, 5000.0, 50'000.0, 1e6}) {
      auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
      p.sample_period_s = static_cast<float>(1.0 / rate_Hz);
      p.jerk_limit = static_cast<float>(jerk);
      p.acceleration_limit = static_cast<float>(std::min(2000.0, jerk));
      const double exact =
          jerk / firmware_test::kEncoderResolution_mm / std::pow(rate_Hz, 3) * static_cast<double>(firmware::kOneCount);
      const auto as_float = firmware::motion_limits(p), as_fixed = firmware::motion_limits(firmware::to_fixed(p));
      EXPECT_EQ(as_fixed.jerk, as_float.jerk) << rate_Hz << ' ' << jerk;
      if (firmware::check(as_fixed) != firmware::Refusal::none) continue;
      ++accepted;
      EXPECT_NEAR(static_cast<double>(as_fixed.jerk) / exact, 1.0, 0.002) << rate_Hz << ' ' << jerk;
    }
  }
  EXPECT_GT(accepted, 20);
}

}  // namespace
