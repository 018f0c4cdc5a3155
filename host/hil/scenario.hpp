// A scenario: the commands to a machine, the injected faults, and the expectations (`axis-scenario/1`).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/hil/commissioning.hpp"
#include "host/hil/injection.hpp"
#include "host/hil/path.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "sim/crossed_table.hpp"

namespace host {

/// Source of the controller's parameters.
enum class Knowledge {
  truth,       ///< designed from the true drive, including effects that the board can compensate
  identified,  ///< commissioned by experiments on this drive: steps, jogs
  model,       ///< a model file
};

struct ScenarioAxis {
  sim::DriveDescription drive;
  std::string program;  ///< external plant program; if set, the simulated effects are ignored
  Knowledge knowledge = Knowledge::truth;
  sim::DriveDescription believed;  ///< for Knowledge::model
  bool zero_phase = true;
  bool friction_feedforward = true;
  bool disturbance_cancellation = false;
  bool compensation = true;  ///< compensate further known effects
  ReferenceLimits limits;
  LoopTuning tuning;
  bool encoder_fault_input = false;  ///< the fault output of the encoder's receivers is wired
  hal::pc::AxisWiring wiring;
};

enum class MoveKind { jog, move_to, stop, circle, square, enable, disable, clear };

struct ScenarioMove {
  double at_s = 0.0;
  MoveKind kind = MoveKind::jog;
  std::size_t axis = 0;      ///< unused for paths
  double speed_mm_s = 0.0;   ///< jog
  double target_mm = 0.0;    ///< move_to
  std::optional<Path> path;  ///< circle, square
  PathLimits path_limits;
};

struct ScenarioFault {
  double at_s = 0.0;
  std::optional<double> until_s;  ///< time at which the fault ends
  const InjectionInfo* injection = nullptr;
  std::size_t axis = 0;
  double value = 0.0;
};

/// One expectation: a fault by a time, a state at the end, or a bound on a signal between two times.
struct Expectation {
  std::size_t line = 0;
  std::size_t axis = 0;
  bool aim = false;  ///< a target only: a run that misses it does not fail
  std::optional<firmware::AxisFault> fault;
  std::optional<double> by_s;
  std::optional<firmware::SupervisorState> state;
  std::string signal;  ///< see kSignals; empty: none
  double from_s = 0.0;
  double to_s = 0.0;
  std::optional<double> at_most, at_least;
  std::optional<std::size_t> of_axis;   ///< the axis that `at_most_share` refers to
  std::optional<double> at_most_share;  ///< of the same signal of `of_axis`
};

/// Signals that expectations may bound, as magnitudes.
inline constexpr std::array<std::string_view, 7> kSignals{"tracking_um", "contour_um",  "speed_rad_s", "disturbance_V",
                                                          "command_V",   "position_mm", "table_um"};

struct Scenario {
  std::string path;
  std::string name;
  std::string about;
  std::uint64_t seed = 1;
  double duration_s = 1.0;
  std::array<ScenarioAxis, hal::kAxisCount> axes;
  sim::CrossedTableErrors table;
  std::optional<sim::BallbarSetting> ballbar;  ///< measures the table: channel radius_mm of x's record
  std::vector<ScenarioMove> moves;
  std::vector<ScenarioFault> faults;
  std::vector<Expectation> expectations;
  bool programs_allowed = false;  ///< the user has consented to the programs of programs_of()
};

/// The command lines that the scenario runs, without repetition. They run only with the user's consent, because a
/// scenario may come from anywhere.
std::vector<std::string> programs_of(const Scenario& scenario);

/// Throws Failure(bad_input) naming file, line, field and remedy. Reads the models that it names from its folder.
Scenario read_scenario(const std::string& path);
Scenario parse_scenario(std::string_view text, const std::string& path);

}  // namespace host
