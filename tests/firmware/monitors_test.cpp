// Each monitor trips beyond its threshold and does not trip just below it. For the hardest permitted motion see
// host/hil.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/fixed_units.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::AxisFault;
using firmware::AxisMonitors;
using firmware::AxisTelemetry;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

firmware::AxisParameters<float> parameters() {
  auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
  p.monitors.travel_min_counts = -1000;
  p.monitors.travel_max_counts = 2000;
  p.monitors.input_samples = 1;
  return p;
}

struct Switches {
  hal::LimitState state;
  hal::LimitState read() const { return state; }
};

/// Fault of an axis with these monitors after `samples` equal samples.
struct Watched {
  AxisTelemetry<float> seen;
  Switches switches;
  int samples = 1;

  AxisFault fault() const {
    AxisMonitors<float> monitors;
    monitors.configure(parameters(), 0);
    for (int k = 1; k < 10 && seen.tachometer_velocity != 0.0f; ++k) {  // up to its speed, not there at once
      AxisTelemetry<float> before = seen;
      before.encoder_travel = seen.encoder_travel * k / 10;
      before.tachometer_velocity = seen.tachometer_velocity * static_cast<float>(k) / 10.0f;
      monitors.watch_sensors(before);
    }
    AxisFault found = AxisFault::none;
    for (int k = 0; k < samples && found == AxisFault::none; ++k) {
      found = monitors.watch_sensors(seen);
      if (found == AxisFault::none) found = seen.enabled ? monitors.watch_motion(seen) : monitors.watch_rest(seen);
      if (found == AxisFault::none && seen.enabled) found = monitors.watch_travel(seen, switches);
    }
    return found;
  }
};

Watched moving_at(float reference_velocity) {
  Watched w;
  w.seen.enabled = true;
  w.seen.reference_velocity = w.seen.estimate.velocity = w.seen.tachometer_velocity = reference_velocity;
  const float counts = reference_velocity * static_cast<float>(firmware_test::kLead_mm_per_rad * 1e-3 /
                                                               firmware_test::kEncoderResolution_mm);
  w.seen.encoder_travel = static_cast<std::int32_t>(counts);
  return w;
}

/// `amount` is the share of the threshold.
struct Case {
  const char* name;
  AxisFault fault;
  std::function<Watched(float amount)> watch;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const auto kLimits = parameters().monitors;

class Monitor : public testing::TestWithParam<Case> {};

TEST_P(Monitor, TripsBeyondItsThreshold) { EXPECT_EQ(GetParam().watch(1.02f).fault(), GetParam().fault); }
TEST_P(Monitor, IsSilentJustBelow) { EXPECT_EQ(GetParam().watch(0.98f).fault(), AxisFault::none); }

INSTANTIATE_TEST_SUITE_P(
    Supervision, Monitor,
    testing::Values(Case{"following_error_standing", AxisFault::following_error,
                         [](float amount) {
                           Watched w = moving_at(0.0f);
                           w.seen.tracking_error = -amount * kLimits.following_error_floor;
                           return w;
                         }},
                    Case{"following_error_at_speed", AxisFault::following_error,
                         [](float amount) {
                           Watched w = moving_at(-100.0f);
                           w.seen.tracking_error =
                               amount * (kLimits.following_error_floor + 100.0f * kLimits.following_error_per_velocity);
                           return w;
                         }},
                    Case{"overspeed", AxisFault::overspeed,
                         [](float amount) {
                           Watched w = moving_at(-amount * kLimits.overspeed);
                           w.seen.reference_velocity = 0.0f;
                           return w;
                         }},
                    Case{"overspeed_by_the_encoder", AxisFault::overspeed,
                         [](float amount) {
                           Watched w = moving_at(amount * kLimits.overspeed);
                           w.seen.tachometer_velocity = 0.97f * kLimits.overspeed;
                           return w;
                         }},
                    Case{"overspeed_by_the_tachometer", AxisFault::overspeed,
                         [](float amount) {
                           Watched w = moving_at(0.97f * kLimits.overspeed);
                           w.seen.tachometer_velocity = amount * kLimits.overspeed;
                           return w;
                         }},
                    Case{"encoder_tachometer_disagreement", AxisFault::encoder_tachometer_disagreement,
                         [](float amount) {
                           Watched w = moving_at(0.0f);
                           w.seen.tachometer_velocity =
                               amount * kLimits.disagreement_floor / (1.0f - amount * kLimits.disagreement_share);
                           w.samples = 200;
                           return w;
                         }},
                    Case{"encoder_jump", AxisFault::encoder_jump,
                         [](float amount) {
                           Watched w = moving_at(0.0f);
                           w.seen.encoder_travel =
                               static_cast<std::int32_t>(amount * kLimits.encoder_jump *
                                                             static_cast<float>(firmware_test::kLead_mm_per_rad * 1e-3 /
                                                                                firmware_test::kEncoderResolution_mm) +
                                                         (amount > 1.0f ? 1.0f : 0.0f));
                           return w;
                         }},
                    Case{"saturation", AxisFault::saturation_too_long,
                         [](float amount) {
                           Watched w = moving_at(0.0f);
                           w.seen.saturated = true;
                           w.samples = static_cast<int>(amount * static_cast<float>(kLimits.saturation_samples)) + 1;
                           return w;
                         }},
                    Case{"positive_travel", AxisFault::travel_limit,
                         [](float amount) {
                           Watched w = moving_at(1.0f);
                           w.seen.encoder_counts = static_cast<std::int64_t>(amount * 2000.0f);
                           w.seen.homed = true;
                           return w;
                         }},
                    Case{"negative_travel", AxisFault::travel_limit,
                         [](float amount) {
                           Watched w = moving_at(-1.0f);
                           w.seen.encoder_counts = static_cast<std::int64_t>(-amount * 1000.0f);
                           w.seen.homed = true;
                           return w;
                         }},
                    Case{"positive_switch", AxisFault::limit_switch_positive,
                         [](float amount) {
                           Watched w = moving_at(1.0f);
                           w.switches.state.positive_end = amount > 1.0f;
                           return w;
                         }},
                    Case{"negative_switch", AxisFault::limit_switch_negative,
                         [](float amount) {
                           Watched w = moving_at(-1.0f);
                           w.switches.state.negative_end = amount > 1.0f;
                           return w;
                         }},
                    Case{"state_not_a_number", AxisFault::state_not_a_number,
                         [](float amount) {
                           Watched w = moving_at(0.0f);
                           w.seen.enabled = false;
                           w.seen.estimate.disturbance = amount > 1.0f ? kNaN : std::numeric_limits<float>::max();
                           return w;
                         }}),
    [](const auto& c) { return c.param.name; });

TEST(TravelMonitor, LetsAnAxisGoBackFromBeyondAnEnd) {
  Watched w = moving_at(-1.0f);
  w.seen.encoder_counts = 5000;
  w.switches.state.positive_end = true;
  EXPECT_EQ(w.fault(), AxisFault::none);
}

TEST(FollowingErrorMonitor, RemembersTheLargest) {
  AxisMonitors<float> monitors;
  monitors.configure(parameters(), 0);
  Watched w = moving_at(0.0f);
  for (const float error : {0.1f, -0.3f, 0.2f}) {
    w.seen.tracking_error = error;
    monitors.watch_motion(w.seen);
  }
  EXPECT_EQ(monitors.high_water(), 0.3f);
}

class BoardMonitor : public testing::Test {
 protected:
  BoardMonitor() {
    watch.configure(firmware::BoardWatch::default_limits(0.001f));
    watch.watch({}, false);
    watch.host_commands(true);
  }
  AxisFault after(std::uint32_t us) { return watch.watch({now += us, false, false, false}, true); }
  firmware::BoardWatch watch;
  std::uint32_t now = 0;
};

TEST_F(BoardMonitor, APeriodIsLateByHalf) {
  EXPECT_EQ(after(1000), AxisFault::none);
  EXPECT_EQ(after(1500), AxisFault::none);
  EXPECT_EQ(after(1501), AxisFault::control_overrun);
  now = 0xFFFFFF00u - 1000u;  // the clock wraps
  after(1000);
  EXPECT_EQ(after(1000), AxisFault::none);
}

TEST_F(BoardMonitor, TheHostMayBeSilentForATenthOfASecond) {
  for (int k = 0; k < 100; ++k) ASSERT_EQ(after(1000), AxisFault::none) << k;
  watch.host_heard();
  for (int k = 0; k < 100; ++k) ASSERT_EQ(after(1000), AxisFault::none) << k;
  EXPECT_EQ(after(1000), AxisFault::host_heartbeat_lost);
}

TEST_F(BoardMonitor, SilenceIsNoFaultWhereTheHostCommandsNothingForAWhile) {
  watch.host_commands(false);
  for (int k = 0; k < 60'000; ++k) ASSERT_EQ(after(1000), AxisFault::none);
  EXPECT_FALSE(watch.was_left_alone());
  EXPECT_EQ(after(1000), AxisFault::none) << "a normal time-out is no fault";
  EXPECT_TRUE(watch.was_left_alone()) << "axes must not stay enabled without a program";
}

TEST_F(BoardMonitor, LinesOfTheBoard) {
  for (std::uint32_t k = 1; k < 3; ++k) EXPECT_EQ(watch.watch({300 * k, true, false, false}, true), AxisFault::none);
  EXPECT_EQ(watch.watch({1000, true, false, false}, true), AxisFault::emergency_stop);
  EXPECT_EQ(watch.watch({2000, false, true, false}, true), AxisFault::supply_low);
  EXPECT_EQ(watch.watch({3000, false, false, true}, false), AxisFault::parameter_store_damaged);
  EXPECT_EQ(watch.watch({4000, false, false, false, true}, false), AxisFault::settings_changed);
  EXPECT_EQ(watch.watch({4000, false, false, false}, true), AxisFault::none);
}

TEST(MonitorLimits, NoneCanBeSwitchedOff) {
  using firmware::Refusal;
  const auto error_after = [](auto change) {
    auto p = parameters();
    change(p.monitors);
    return firmware::check_monitors(p);
  };
  EXPECT_EQ(error_after([](auto&) {}), Refusal::none);
  EXPECT_EQ(error_after([](auto& m) { m.following_error_floor = 0.0f; }), Refusal::following_error);
  EXPECT_EQ(error_after([](auto& m) { m.disagreement_share = 1.5f; }), Refusal::disagreement);
  EXPECT_EQ(error_after([](auto& m) { m.encoder_jump = std::numeric_limits<float>::infinity(); }),
            Refusal::disagreement);
  EXPECT_EQ(error_after([](auto& m) { m.overspeed = 100.0f; }), Refusal::overspeed);
  EXPECT_EQ(error_after([](auto& m) { m.polarity_command_V = kNaN; }), Refusal::polarity_command);
  EXPECT_EQ(error_after([](auto& m) { m.oscillation_V = 0.0f; }), Refusal::oscillation);
  EXPECT_EQ(error_after([](auto& m) { m.travel_max_counts = m.travel_min_counts; }), Refusal::travel);
  EXPECT_EQ(error_after([](auto& m) { m.saturation_samples = 0; }), Refusal::saturation_time);
}

/// Catches a row of the table that refers to another row's field.
TEST(MonitorLimits, EachParameterSetsAFieldOfItsOwn) {
  const auto limits_with = [](unsigned changed) {
    return firmware::monitor_limits<float>([&](auto id) { return decltype(id)::value == changed ? 2.0f : 1.0f; }, 1.0f,
                                           1.0f);
  };
  const auto usual = limits_with(0);
  for (const firmware::ThresholdRow& row : firmware::kThresholdRows) {
    const auto changed = limits_with(row.id);
    firmware::for_each_threshold([&](auto index) {
      constexpr auto kThreshold = std::get<index()>(firmware::kThresholds<float>);
      const bool differs = usual.*kThreshold.field != changed.*kThreshold.field;
      EXPECT_EQ(differs, kThreshold.row.id == row.id) << row.name << " and " << kThreshold.row.name;
    });
  }
}

TEST(MonitorLimits, HaveTheSameMeaningInFixedPoint) {
  const auto p = parameters();
  const auto q = firmware::to_fixed(firmware_test::parameters_of<double>(firmware_test::kPaperX));
  const firmware::FixedUnits<float> unit(p);
  const auto value = [](firmware::FixedPoint f) { return static_cast<float>(f.raw()) / 2097152.0f; };
  EXPECT_NEAR(value(q.monitors.following_error_floor) * unit.length, p.monitors.following_error_floor, 1e-6f);
  EXPECT_NEAR(value(q.monitors.overspeed) * unit.velocity, p.monitors.overspeed, 1e-4f);
  EXPECT_NEAR(value(q.monitors.polarity_command_V) * unit.volts, p.monitors.polarity_command_V, 1e-5f);
}

}  // namespace
