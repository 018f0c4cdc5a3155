// Friction at constant speeds by two methods: from the mean control signal, and from the disturbance of the Kalman
// filter.
#pragma once

#include <optional>
#include <vector>

#include "host/identify/axis_design.hpp"
#include "host/identify/constant_speed.hpp"
#include "host/record/record.hpp"

namespace host {

/// Disturbance estimate d (V at the control signal) of a whole record by eq. (43). Starts at rest with the first
/// sample. The record needs a position.
std::vector<double> observe_disturbance(const Record& record, const AxisDesign& design, const sim::DataSheet& data);

/// Friction in one interval of constant speed, with its sign; includes the viscous part.
struct FrictionPoint {
  double speed = 0.0;           ///< rad/s or m/s
  double effort = 0.0;          ///< mean control torque or force minus the remaining J dw/dt, Nm or N
  double standard_error = 0.0;  ///< standard error of `effort`, from the scatter of its parts
  /// From the disturbance: Ka Kt d + B w, with B of the observer's design. Empty if there is no position.
  std::optional<double> observed_effort;
  double duration_s = 0.0;  ///< duration of the average
  double turns = 0.0;       ///< turns of the screw; a whole number if one fits, 0 for a linear drive
  double jitter =
      0.0;  ///< standard deviation of the speed above 10 Hz that the control signal itself causes, rad/s or m/s
  std::size_t record = 0;  ///< index of the record
  double start_s = 0.0;    ///< start of the interval in that record

  /// Whether the axis slides all the time. If the speed jitters through zero, friction changes its sign within the
  /// interval and its mean is too small. This happens at the lowest jog speeds of a drive with a noisy tachometer.
  bool is_steady() const;
};

/// The points of all intervals in all records. The design gives J and B. A record without a tachometer needs a design
/// without one.
std::vector<FrictionPoint> friction_points(const std::vector<Record>& records, const sim::DataSheet& data,
                                           const AxisDesign& design, const ConstantSpeedOptions& options = {});

}  // namespace host
