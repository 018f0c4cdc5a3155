// One closed loop for all axes of a machine, so that straight lines stay straight (Erkorkmaz & Altintas 2001, p. 1487).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/axes/contour_forecast.hpp"
#include "host/parameters/drive_limits.hpp"
#include "host/response/loop_design.hpp"

namespace host {

struct AxisTask {
  sim::DriveDescription model;
  std::optional<AxisResponse> measured;  ///< measured response with a fit; if empty, the model is used
  /// Rwd and Rw of this axis; if empty, those of DesignOptions.
  std::optional<double> disturbance_variance = {}, tach_variance = {};
};

struct AxisLoop {
  sim::DriveDescription model;  ///< model of the design: without its tachometer if another axis has none
  AxisDesign design;
  ControlFilterChoice filters;
  std::optional<double> modulus;  ///< modulus margin on the measured drive, or on the model
  DriveLimits limits;             ///< limits of the references
};

struct LoopSet {
  std::vector<AxisLoop> axes;
  std::vector<FeedContour> contour;  ///< for each feed, the worst of all pairs of axes
  std::string remaining;             ///< effect that causes most of that error; empty if none dominates
};

struct MachineDesign {
  LoopSet matched;         ///< equal poles of loop and estimator, equal filters and feed-forward
  LoopSet own;             ///< the best loop of each axis
  std::string limited_by;  ///< cause that limits the bandwidth of the matched loop
};

/// `options`, `aim` and `limits` apply to every axis, except for an axis's own variances. Throws Failure: usage for
/// inconsistent names or sampling periods, refused if no common bandwidth meets the requirements or a loop would be
/// unstable, and what design_axis() and drive_limits() throw.
MachineDesign design_machine(const std::vector<AxisTask>& tasks, const DesignOptions& options, const LoopAim& aim,
                             const LimitWishes& limits = {});

nlohmann::json machine_json(const MachineDesign& machine);

}  // namespace host
