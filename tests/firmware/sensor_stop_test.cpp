// A sensor fails in motion: the axis slows down with the remaining one.
#include "firmware/core/supervision/sensor_stop.hpp"

#include <algorithm>
#include <cmath>

#include "tests/firmware/driven_axis.hpp"

namespace {

using firmware::AxisFault;
using firmware::SupervisorState;
using firmware_test::DrivenAxis;

constexpr double kAcceleration = 2000.0;  // mm/s^2, parameters_of()

struct Stop {
  double way_mm = 0.0, longest_s = 0.0, still_mm_s = 0.0;
  bool was_let_go_at_speed = false;
};

class SensorStop : public testing::Test {
 protected:
  /// Without friction: an axis without current coasts for ever.
  static firmware::AxisParameters<float> parameters() {
    return firmware_test::parameters_of<float>(firmware_test::kPaperX);
  }

  /// Jogs, applies `fail` to the axis before each of the following samples, and returns the result.
  template <typename Fail>
  static Stop stop(DrivenAxis& axis, float speed_mm_s, Fail fail) {
    EXPECT_TRUE(axis.axis.jog(speed_mm_s));
    for (int k = 0; k < 600; ++k) axis.step();
    const double begin_mm = axis.at_mm();
    Stop stop;
    bool was_on = true;
    double before_mm = begin_mm;
    for (int k = 0; k < 2000; ++k) {
      fail(axis, k);
      axis.step();
      stop.still_mm_s = (axis.at_mm() - before_mm) * 1e3;
      before_mm = axis.at_mm();
      if (was_on && !axis.io.drive_enable().on) {
        stop.longest_s = 1e-3 * k;
        stop.was_let_go_at_speed = std::abs(stop.still_mm_s) > 5.0;
      }
      was_on = axis.io.drive_enable().on;
    }
    stop.way_mm = axis.at_mm() - begin_mm;
    EXPECT_EQ(axis.axis.state(), SupervisorState::fault);
    return stop;
  }
  static void expect_ramp(const Stop& stop, double speed_mm_s, double deceleration = kAcceleration) {
    EXPECT_FALSE(stop.was_let_go_at_speed);
    EXPECT_LT(std::abs(stop.way_mm), speed_mm_s * speed_mm_s / (2.0 * deceleration) + 2.0);
    EXPECT_LT(std::abs(stop.still_mm_s), 3.0);
    EXPECT_LT(stop.longest_s, std::abs(speed_mm_s) / deceleration + 0.1);
  }
};

TEST_F(SensorStop, ADeadTachometerLeavesTheEncoder) {
  for (const float speed : {250.0f, -250.0f, 60.0f}) {
    DrivenAxis axis(parameters());
    const Stop found = stop(axis, speed, [](DrivenAxis& a, int) { a.io.tachometer().reading.code = 0; });
    EXPECT_EQ(axis.axis.fault(), AxisFault::encoder_tachometer_disagreement);
    expect_ramp(found, static_cast<double>(speed));
  }
}

/// 15.6 mm at the reference's limit, 7.8 mm at twice that.
TEST_F(SensorStop, FaultsHaveADecelerationOfTheirOwn) {
  auto p = parameters();
  p.fault_deceleration = 4000.0f;
  DrivenAxis axis(p);
  const Stop found = stop(axis, 250.0f, [](DrivenAxis& a, int) { a.io.tachometer().reading.valid = false; });
  expect_ramp(found, 250.0, 4000.0);
  EXPECT_GT(found.way_mm, 6.0);
}

/// v^2 / (2 a) + v a / (2 j) with a of a fault; normal stops use a of the reference.
TEST_F(SensorStop, ARampByAFaultHasThatDecelerationToo) {
  auto p = parameters();
  p.jerk_limit = 200'000.0f;
  p.fault_deceleration = 5000.0f;
  const auto way_mm = [](DrivenAxis& axis, auto begin_stop) {
    EXPECT_TRUE(axis.axis.jog(250.0f));
    for (int k = 0; k < 600; ++k) axis.step();
    const double begin_mm = axis.at_mm();
    begin_stop(axis);
    for (int k = 0; k < 1000; ++k) axis.step();
    return axis.at_mm() - begin_mm;
  };
  const auto by_itself = [](DrivenAxis& a) { a.axis.stop(); };
  const double usual = 250.0 * 250.0 / 4000.0 + 250.0 * 2000.0 / 400'000.0;
  const double hard = 250.0 * 250.0 / 10'000.0 + 250.0 * 5000.0 / 400'000.0;
  DrivenAxis axis(p);
  EXPECT_NEAR(way_mm(axis, by_itself), usual, 1.5);
  EXPECT_NEAR(way_mm(axis, [](DrivenAxis& a) { a.step(AxisFault::host_heartbeat_lost); }), hard, 1.5);
  EXPECT_TRUE(axis.axis.clear_fault());
  for (int k = 0; k < firmware::kSelfTestSamples + 1; ++k) axis.step();
  EXPECT_TRUE(axis.axis.enable());
  axis.step();
  EXPECT_NEAR(way_mm(axis, by_itself), usual, 1.5) << "enabled anew";
}

TEST_F(SensorStop, ATachometerWithoutReadingLeavesTheEncoder) {
  DrivenAxis axis(parameters());
  const Stop found = stop(axis, 250.0f, [](DrivenAxis& a, int) { a.io.tachometer().reading.valid = false; });
  EXPECT_EQ(axis.axis.fault(), AxisFault::tachometer_invalid);
  expect_ramp(found, 250.0);
  EXPECT_TRUE(axis.axis.is_homed()) << "the encoder counted on";
}

TEST_F(SensorStop, ADeadEncoderLeavesTheTachometer) {
  for (const bool is_reported : {false, true}) {
    DrivenAxis axis(parameters());
    std::uint32_t at = 0;
    const Stop found = stop(axis, 250.0f, [&](DrivenAxis& a, int k) {
      if (k == 0) at = a.io.encoder().reading.counts;
      a.io.encoder().reading = {at, !is_reported};
    });
    EXPECT_EQ(axis.axis.fault(), is_reported ? AxisFault::encoder_invalid : AxisFault::encoder_jump);
    expect_ramp(found, 250.0);
    EXPECT_FALSE(axis.axis.is_homed());
  }
}

/// The sensors disagree before the receivers' report has passed its filter. The unfiltered report decides which of them
/// is dead.
TEST_F(SensorStop, ReceiversThatReportABrokenWireDecideWhichSensorIsDead) {
  for (const bool is_wired : {false, true}) {
    auto p = parameters();
    p.encoder_fault_input = is_wired;
    DrivenAxis axis(p);
    std::uint32_t at = 0;
    const Stop found = stop(axis, 250.0f, [&](DrivenAxis& a, int k) {
      if (k == 0) at = a.io.encoder().reading.counts;
      a.io.encoder().reading.counts = at;
      a.io.encoder().faulted = true;
    });
    EXPECT_EQ(axis.axis.fault(), is_wired ? AxisFault::encoder_invalid : AxisFault::encoder_jump);
    expect_ramp(found, 250.0);
  }
}

/// 2 V of load are held without a tachometer, the encoder is unplugged, and the load changes by 0.8 V.
TEST_F(SensorStop, AnUnpluggedEncoderAtRestUnderLoadIsFoundByItsReceivers) {
  for (const bool is_wired : {false, true}) {
    auto p = parameters();
    p.tachometer_fitted = false;
    p.disturbance_cancellation_on = true;
    p.encoder_fault_input = is_wired;
    p.sequence.brake_fitted = is_wired;  // refused otherwise
    DrivenAxis axis(p);
    for (int k = 0; k < 3000; ++k) {
      axis.stuck_V = k < 2000 ? -0.001 * k : -2.0;
      axis.step();
    }
    ASSERT_EQ(axis.axis.fault(), AxisFault::none);
    const double held_mm = axis.at_mm();
    const std::uint32_t at = axis.io.encoder().reading.counts;
    axis.stuck_V = -2.8;
    axis.io.encoder().faulted = true;
    int samples = 0;
    for (; samples < 3000 && axis.axis.fault() == AxisFault::none; ++samples) {
      axis.io.encoder().reading.counts = at;
      axis.step();
    }
    if (!is_wired) {
      EXPECT_GT(std::abs(axis.at_mm() - held_mm), 100.0) << "what does the input prevent?";
      continue;
    }
    EXPECT_EQ(axis.axis.fault(), AxisFault::encoder_invalid);
    EXPECT_LE(samples, 3);
    EXPECT_LT(std::abs(axis.at_mm() - held_mm), 0.1);
    EXPECT_FALSE(axis.io.drive_enable().on);
    EXPECT_FALSE(axis.io.drive_enable().brake_released);
  }
}

TEST_F(SensorStop, WithoutATachometerADeadEncoderDropsTheEnable) {
  auto p = parameters();
  p.tachometer_fitted = false;
  p.Kobs = {{{0.5f, 0.0f}, {60.0f, 0.0f}, {-20.0f, 0.0f}}};
  firmware::boards::ValueAxis io;
  if (firmware::SupervisedAxis<float, firmware::boards::ValueAxis> probe(io);
      probe.configure(p) != firmware::Refusal::none)
    GTEST_SKIP() << "these gains are refused";
  DrivenAxis axis(p);
  const Stop found = stop(axis, 100.0f, [](DrivenAxis& a, int) { a.io.encoder().reading.valid = false; });
  EXPECT_EQ(found.longest_s, 0.0);
}

TEST_F(SensorStop, AStopWhoseSensorFailsTooDropsTheEnable) {
  DrivenAxis axis(parameters());
  const Stop found = stop(axis, 250.0f, [](DrivenAxis& a, int k) {
    a.io.tachometer().reading.code = 0;
    if (k > 30) a.io.encoder().reading.valid = false;
  });
  EXPECT_NEAR(found.longest_s, 0.031, 0.002);
}

/// A slow stop by a tachometer with a wrong offset, and then the encoder's wires are cut: the reference continues, and
/// the growing command would drive the axis undetected.
TEST_F(SensorStop, AStopWhoseEncoderFallsSilentIsLetGoBeforeTheAxisGainsSpeed) {
  for (const int silent_at : {220, 233, 250}) {
    auto p = parameters();
    p.acceleration_limit = 200.0f;
    p.monitors.disagreement_floor = 26.0f;  // the drive obeys if it is not faster than the reference by twice this
    DrivenAxis axis(p);
    std::uint32_t at = 0;
    double before_mm = 0.0, fastest_mm_s = 0.0;
    stop(axis, 75.0f, [&](DrivenAxis& a, int k) {
      a.io.tachometer().reading.code += 64 * 76;
      if (k <= silent_at) at = a.io.encoder().reading.counts;
      if (k > silent_at) fastest_mm_s = std::max(fastest_mm_s, std::abs(a.at_mm() - before_mm) * 1e3);
      before_mm = a.at_mm();
      a.io.encoder().reading.counts = at;
    });
    EXPECT_LT(fastest_mm_s, 40.0) << silent_at << ": rises from 25 to 31 mm/s; to 60 if the enable does not drop";
  }
}

/// The same with lost encoder counts, and then a dead tachometer.
TEST_F(SensorStop, AStopWhoseTachometerFallsSilentIsLetGoBeforeTheAxisGainsSpeed) {
  for (const int silent_at : {220, 233, 250}) {
    auto p = parameters();
    p.acceleration_limit = 200.0f;
    p.monitors.disagreement_floor = 26.0f;
    DrivenAxis axis(p);
    double before_mm = 0.0, fastest_mm_s = 0.0;
    stop(axis, 75.0f, [&](DrivenAxis& a, int k) {
      a.io.encoder().reading.counts += 300;
      if (k > silent_at) a.io.tachometer().reading.code = 0;
      if (k > silent_at) fastest_mm_s = std::max(fastest_mm_s, std::abs(a.at_mm() - before_mm) * 1e3);
      before_mm = a.at_mm();
    });
    EXPECT_LT(fastest_mm_s, 40.0) << silent_at;
  }
}

/// The motor is driven, but not by the command.
TEST_F(SensorStop, ADriveThatDoesNotObeyIsLetGo) {
  DrivenAxis axis(parameters());
  const Stop found = stop(axis, 100.0f, [](DrivenAxis& a, int) {
    a.io.tachometer().reading.code = 0;
    a.amplifier_offset_V = 10.0;
  });
  EXPECT_LT(found.longest_s, 0.03);
}

/// A stuck converter drives a standing axis whose encoder is dead: the encoder shows rest, the tachometer the motion.
TEST_F(SensorStop, AnAxisThatRunsAwayFromASilentEncoderIsLetGo) {
  DrivenAxis axis(parameters());
  std::uint32_t at = 0;
  stop(axis, 5.0f, [&](DrivenAxis& a, int k) {
    if (k == 0) at = a.io.encoder().reading.counts;
    a.io.encoder().reading.counts = at;
    a.amplifier_offset_V = -8.0;
    if (k == 40) {
      EXPECT_FALSE(a.io.drive_enable().on);
    }
  });
}

/// Only the stop's arithmetic: the test sets the readings of the sensors.
class SensorStopAlone : public testing::Test {
 protected:
  SensorStopAlone() {
    stop.configure(p);
    most = 2.0f * p.monitors.disagreement_floor;
  }
  /// `encoder`, `tachometer` and `reference`, rad/s.
  firmware::AxisTelemetry<float> seen(float encoder, float tachometer, float reference) const {
    firmware::AxisTelemetry<float> all;
    all.encoder_travel =
        static_cast<std::int32_t>(std::lround(encoder * p.lead * p.sample_period_s / p.encoder_resolution));
    all.tachometer_velocity = tachometer;
    all.reference_velocity = reference;
    return all;
  }
  float per_count() const { return p.encoder_resolution / (p.lead * p.sample_period_s); }

  firmware::AxisParameters<float> p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
  firmware::SensorStop<float> stop;
  float most = 0.0f;
};

/// Near rest a dead encoder looks like a correct one; at speed it does not.
TEST_F(SensorStopAlone, SensorsThatDivergeNearRestLeaveTheEncoder) {
  using firmware::TrustedSensor;
  constexpr auto kDiverged = AxisFault::encoder_tachometer_disagreement;
  for (const float sign : {1.0f, -1.0f}) {
    EXPECT_EQ(stop.trusted_after(kDiverged, seen(0.0f, 0.0f, sign * 0.9f * most)), TrustedSensor::encoder);
    EXPECT_EQ(stop.trusted_after(kDiverged, seen(0.0f, 0.0f, sign * 1.1f * most)), TrustedSensor::tachometer);
    EXPECT_EQ(stop.trusted_after(kDiverged, seen(sign * 0.5f * most, 0.0f, sign * 1.1f * most)),
              TrustedSensor::encoder);
  }
}

/// If sensors diverged near rest, it is unknown which one is wrong: the speed of the other sensor must not grow.
TEST_F(SensorStopAlone, ADoubtfulEncoderIsLetGoOnceTheTachometerGainsSpeed) {
  constexpr auto kDiverged = AxisFault::encoder_tachometer_disagreement;
  for (const float sign : {1.0f, -1.0f}) {
    stop.begin(firmware::TrustedSensor::encoder, kDiverged, seen(0.0f, sign * 3.0f, 0.0f), 0.0f);
    EXPECT_TRUE(stop.next(seen(0.0f, sign * (2.9f + most), 0.0f)));
    EXPECT_FALSE(stop.next(seen(0.0f, sign * (3.1f + most), 0.0f)));
  }
  stop.begin(firmware::TrustedSensor::encoder, AxisFault::tachometer_invalid, seen(0.0f, 3.0f, 0.0f), 0.0f);
  EXPECT_TRUE(stop.next(seen(0.0f, 10.0f * most, 0.0f))) << "the encoder is not doubted";
}

/// If the drive creeps at rest, the command grows with its travel: Kc1 times a count each sample, up to the converter's
/// limit.
TEST_F(SensorStopAlone, HoldsThePositionAtRest) {
  constexpr float kLoad_V = 0.25f;
  stop.begin(firmware::TrustedSensor::encoder, AxisFault::tachometer_invalid, seen(0.0f, 0.0f, 0.0f), kLoad_V);
  const firmware::AxisTelemetry<float> creeping = seen(per_count(), 0.0f, 0.0f);
  for (int k = 0; k < 30; ++k) EXPECT_TRUE(stop.next(creeping));
  const float before_V = stop.command_V();
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(stop.next(creeping));
  EXPECT_NEAR(stop.command_V() - before_V, -10.0f * p.Kc[0] * p.encoder_resolution, 1e-3f);
  EXPECT_LT(before_V, kLoad_V - 28.0f * p.Kc[0] * p.encoder_resolution);
}

TEST_F(SensorStop, TheBrakeHoldsBeforeTheEnableDrops) {
  auto p = parameters();
  p.sequence = {
      .ready_input = false, .brake_fitted = true, .amplifier_wait = 0, .brake_release = 10, .brake_application = 40};
  DrivenAxis axis(p);
  for (int k = 0; k < 20; ++k) axis.step();
  int held_by_both = 0;
  stop(axis, 250.0f, [&](DrivenAxis& a, int) {
    a.io.tachometer().reading.valid = false;
    if (a.io.drive_enable().on && !a.io.drive_enable().brake_released) ++held_by_both;
  });
  EXPECT_GE(held_by_both, 39);
}

}  // namespace
