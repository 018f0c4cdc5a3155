// Runs a scenario and says what became of it.
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
  double at_s = 0.0;                 ///< the fault was latched
  std::optional<double> reaction_s;  ///< since the last injection before it; empty without one
  std::optional<double> standing_s;  ///< from the fault until the axis stood, outputs off; empty: not before the end
  double distance_mm = 0.0;          ///< travelled meanwhile
};

struct CheckedExpectation {
  std::string text;
  std::string found;
  bool holds = false;
  bool aim = false;  ///< missed, it does not make the run fail
};

struct ScenarioRun {
  std::array<Record, hal::kAxisCount> records;
  std::array<std::vector<double>, hal::kAxisCount> tracking_um;
  std::array<std::vector<double>, hal::kAxisCount> table_um;       ///< where the table is wanted less where it is
  std::array<std::vector<double>, hal::kAxisCount> disturbance_V;  ///< the Kalman filter's
  std::vector<double> contour_um;                                  ///< empty without a path
  std::vector<PlanePoint> path_points;  ///< encoders, from where the last path began, while it was followed
  std::array<sim::DriveDescription, hal::kAxisCount> believed;  ///< what the controllers were designed from
  std::array<double, hal::kAxisCount> high_water_um{};
  std::vector<StopEvent> stops;
  std::vector<CheckedExpectation> expectations;
  double simulated_s = 0.0;
  double wall_s = 0.0;

  bool holds() const;       ///< all that must
  bool misses_aim() const;  ///< and something that was wished for does not
  double times_real_time() const { return wall_s > 0.0 ? simulated_s / wall_s : 0.0; }
};

/// What makes the noise of an axis' commissioning, where the controller's knowledge is identified.
std::uint64_t commissioning_seed(const Scenario& scenario, std::size_t axis);

/// Time 0 is when both axes have passed their self-test and been enabled; a scenario whose store is damaged from 0 on
/// begins before that. Deterministic by the scenario's seed. Throws Failure(refused) where it runs programs that are
/// not allowed.
ScenarioRun run_scenario(const Scenario& scenario);

}  // namespace host
