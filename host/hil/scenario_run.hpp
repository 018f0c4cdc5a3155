// Runs a scenario and reports its result.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/hil/scenario.hpp"
#include "host/record/record.hpp"

namespace host {

/// How one axis came to rest after a fault.
struct StopEvent {
  std::size_t axis = 0;
  firmware::AxisFault fault = firmware::AxisFault::none;
  double at_s = 0.0;                 ///< time at which the fault was latched
  std::optional<double> reaction_s;  ///< time since the last injection before it; empty without an injection
  std::optional<double>
      standing_s;            ///< from the fault until the axis was at rest with outputs off; empty if it was not
  double distance_mm = 0.0;  ///< travel during that time
};

struct CheckedExpectation {
  std::string text;
  std::string found;
  bool holds = false;
  bool aim = false;  ///< a target: if missed, the run does not fail
};

struct ScenarioRun {
  std::array<Record, hal::kAxisCount> records;
  std::array<std::vector<double>, hal::kAxisCount> tracking_um;
  std::array<std::vector<double>, hal::kAxisCount> table_um;       ///< reference minus actual position of the table
  std::array<std::vector<double>, hal::kAxisCount> disturbance_V;  ///< estimate of the Kalman filter
  std::vector<double> contour_um;                                  ///< empty without a path
  std::vector<PlanePoint> path_points;  ///< encoders since the start of the last path, while it was followed
  std::array<sim::DriveDescription, hal::kAxisCount> believed;  ///< models for which the controllers were designed
  std::array<double, hal::kAxisCount> high_water_um{};
  std::vector<StopEvent> stops;
  std::vector<CheckedExpectation> expectations;
  double simulated_s = 0.0;
  double wall_s = 0.0;

  bool holds() const;       ///< all requirements are met
  bool misses_aim() const;  ///< all requirements are met, but a target is missed
  double times_real_time() const { return wall_s > 0.0 ? simulated_s / wall_s : 0.0; }
};

/// Seed of the noise in an axis's commissioning, if its controller is identified.
std::uint64_t commissioning_seed(const Scenario& scenario, std::size_t axis);

/// Time 0 is when both axes have passed their self-test and been enabled. A scenario whose parameter store is damaged
/// from time 0 on begins before that. Deterministic by the scenario's seed. Throws Failure(refused) if it runs programs
/// that are not allowed.
ScenarioRun run_scenario(const Scenario& scenario);

}  // namespace host
