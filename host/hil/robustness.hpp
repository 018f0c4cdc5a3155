// Contour error if a machine differs from the model of its controller. The more a feed-forward cancels, the more it
// depends on the model (Erkorkmaz & Altintas 2001, p. 1487; Pritschow and Philipp).
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "firmware/core/axis_parameters.hpp"
#include "hal/axis_count.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Controllers; each adds one function to the previous one.
inline constexpr std::array kControllers = {"feedback", "+ ZPETC", "+ friction", "+ cancellation"};

struct RobustnessAxis {
  sim::DriveDescription drive;  ///< the controller's model of the drive
  firmware::AxisParameters<float> parameters;
};
using RobustnessMachine = std::array<RobustnessAxis, hal::kAxisCount>;

/// An axis with this drive and the board parameters in `file`; without a file, a design with defaults. Throws as
/// put_file() and design_axis(), and Failure(bad_input) for a linear drive or a drive without encoder steps.
RobustnessAxis robustness_axis(const sim::DriveDescription& drive, const std::string& file);

struct RobustnessOptions {
  double radius_mm = 35.0, feed_mm_s = 170.0;                ///< the paper's circle, p. 1508
  std::array<bool, hal::kAxisCount> differs = {true, true};  ///< axes whose drives differ from their models
};

/// Contour error of one circle from rest to rest, averaged over several seeds.
struct ContourFigures {
  double most_um = 0.0, rms_um = 0.0;  ///< NaN after a fault
  std::string fault;                   ///< fault that ended a run; empty if none
};

struct RobustnessPoint {
  double change = 0.0;
  std::array<ContourFigures, kControllers.size()> by_controller;
};

/// Contour errors over the change of one quantity of the drives.
struct RobustnessCurve {
  std::string quantity, unit;
  std::vector<RobustnessPoint> points;  ///< ascending; includes a change of 0
};

struct Robustness {
  RobustnessOptions options;
  std::vector<RobustnessCurve> curves;  ///< inertia +-20 %, friction +-30 %, delay up to one control period more
};

/// Simulates the circle for every change and controller.
Robustness find_robustness(const RobustnessMachine& machine, const RobustnessOptions& options);

/// "axis-robustness/1".
nlohmann::json robustness_json(const Robustness& found);
std::string robustness_text(const Robustness& found, const Terminal& terminal);
Report robustness_report(const Robustness& found, const std::string& subtitle);

}  // namespace host
