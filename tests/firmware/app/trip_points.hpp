// Thresholds of the monitors of an axis, found by raising their inputs gradually.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/core/supervision/axis_monitors.hpp"

namespace firmware_test {

/// One number per monitor: the step of a geometric ramp at which it trips first, or the number of tolerated samples.
template <typename Scalar>
std::vector<std::int32_t> trip_points(const firmware::AxisParameters<Scalar>& parameters) {
  using Telemetry = firmware::AxisTelemetry<Scalar>;
  using Monitors = firmware::AxisMonitors<Scalar>;
  struct Switches {
    hal::LimitState read() const { return {}; }
  } switches;

  const auto first_trip = [&](int samples, auto&& set, auto&& watch) {
    float level = 1e-3f;
    std::int32_t step = 0;
    for (; step < 2000 && level < 1e9f; ++step, level *= 1.02f) {
      Monitors monitors;
      monitors.configure(parameters, 0);
      Telemetry seen;
      set(seen, level);
      for (int k = 0; k < samples; ++k)
        if (watch(monitors, seen) != firmware::AxisFault::none) return step;
    }
    return step;
  };
  const auto motion = [](Monitors& monitors, const Telemetry& seen) { return monitors.watch_motion(seen); };
  const auto sensors = [](Monitors& monitors, const Telemetry& seen) { return monitors.watch_sensors(seen); };
  const auto travel = [&](Monitors& monitors, const Telemetry& seen) { return monitors.watch_travel(seen, switches); };
  const auto tachometer = [](Telemetry& seen, float level) { seen.tachometer_velocity = Scalar(level); };

  std::vector<std::int32_t> points;
  points.push_back(first_trip(
      1, [](Telemetry& seen, float level) { seen.tracking_error = Scalar(level); }, motion));
  points.push_back(first_trip(
      1,
      [](Telemetry& seen, float level) {
        seen.reference_velocity = Scalar(100.0f);
        seen.tracking_error = Scalar(level);
      },
      motion));
  points.push_back(first_trip(1, tachometer, sensors));
  points.push_back(first_trip(120, tachometer, sensors));
  points.push_back(first_trip(
      1, [](Telemetry& seen, float level) { seen.tachometer_velocity = Scalar(level); }, motion));
  points.push_back(first_trip(
      20, [](Telemetry& seen, float level) { seen.output_V = Scalar(level); }, motion));
  int sample = 0;
  points.push_back(first_trip(
      200, [](Telemetry& seen, float level) { seen.feedback_V = Scalar(level); },
      [&sample](Monitors& monitors, Telemetry seen) {
        if (++sample % 2 == 0) seen.feedback_V = Scalar(0) - seen.feedback_V;
        return monitors.watch_motion(seen);
      }));
  for (const std::int64_t sign : {1, -1}) {
    points.push_back(first_trip(
        1,
        [sign](Telemetry& seen, float level) {
          seen.reference_velocity = Scalar(static_cast<int>(sign));
          seen.encoder_counts = sign * static_cast<std::int64_t>(1000.0f * level);
          seen.homed = true;
        },
        travel));
  }
  Monitors monitors;
  monitors.configure(parameters, 0);
  Telemetry saturated;
  saturated.saturated = true;
  std::int32_t borne = 0;
  while (borne < 100'000 && monitors.watch_motion(saturated) == firmware::AxisFault::none) ++borne;
  points.push_back(borne);
  return points;
}

}  // namespace firmware_test
