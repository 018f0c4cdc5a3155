// Limits of an axis's references that keep its command out of saturation (Erkorkmaz & Altintas 2001, p. 1490).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/parameters/board_parameters.hpp"

namespace host {

struct LimitWishes {
  double reserve = 0.3;                  ///< share of torque or force reserved for feedback and cutting, 0 to below 1
  bool as_the_drive_allows = false;      ///< otherwise the usual limits, lowered if the drive requires it
  std::optional<double> top_speed_mm_s;  ///< limit of screw and guides; empty: the usual limit of velocity
  std::optional<double> measured_Hz;     ///< lowest measured resonance; empty: the model's
  double loop_Hz = 30.0;                 ///< natural frequency of the closed loop
};

struct DriveLimit {
  double value = 0.0;  ///< infinite if nothing in the model limits it
  std::string by;      ///< the cause of the limit
};

/// Values in mm (rotary) or m (linear).
struct DriveLimits {
  double reserve = 0.0;
  DriveLimit velocity;      ///< up to this speed the drive has at least half of its acceleration at standstill
  DriveLimit acceleration;  ///< possible up to the written velocity, in both directions, speeding up and braking
  DriveLimit jerk;          ///< the acceleration builds up over one period of the lowest resonance or of the loop
  ReferenceLimits written;
  double command_V = 0.0;                ///< largest command at the written velocity and acceleration
  double limit_V = 0.0;                  ///< largest command that has an effect there
  std::vector<std::string> not_counted;  ///< kinds of the model's effects whose torque or force is not included
};

/// Includes inertia, friction that depends only on speed, weight, cogging, the converter's range, limits of
/// current and voltage, and the resonance. Throws Failure(bad_input) as rigid_axis(), and Failure(refused) if friction
/// and weight leave nothing for acceleration.
DriveLimits drive_limits(const sim::DriveDescription& model, const LimitWishes& wishes);

/// {"reserve", "drive": {"velocity": {"value", "by"}, …}, "written": {…}, "command_V", "limit_V", "not_counted"}.
nlohmann::json drive_limits_json(const DriveLimits& limits);

}  // namespace host
