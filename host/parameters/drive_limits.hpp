// Limits of an axis' references that keep its command out of saturation (Erkorkmaz & Altintas 2001, p. 1490).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/parameters/board_parameters.hpp"

namespace host {

struct LimitWishes {
  double reserve = 0.3;                  ///< share of the effort that stays free for feedback and cutting, 0 to below 1
  bool as_the_drive_allows = false;      ///< otherwise the usual limits, lowered where the drive needs it
  std::optional<double> top_speed_mm_s;  ///< of screw and guides; none: the usual limit of velocity
  std::optional<double> measured_Hz;     ///< lowest measured resonance; none: the model's
  double loop_Hz = 30.0;                 ///< natural frequency of the closed loop
};

struct DriveLimit {
  double value = 0.0;  ///< infinite if nothing in the model limits it
  std::string by;      ///< what limits it
};

/// Figures in mm (rotary) or m (linear).
struct DriveLimits {
  double reserve = 0.0;
  DriveLimit velocity;      ///< the drive keeps half of its acceleration at standstill up to this speed
  DriveLimit acceleration;  ///< up to the written velocity, in both directions, speeding up and braking
  DriveLimit jerk;          ///< the acceleration takes one period of the lowest resonance, and of the loop
  ReferenceLimits written;
  double command_V = 0.0;                ///< largest command at the written velocity and acceleration
  double limit_V = 0.0;                  ///< largest command that has an effect there
  std::vector<std::string> not_counted;  ///< kinds of the model's effects that take effort, of unknown size here
};

/// Counts inertia, every friction that depends on speed alone, weight, cogging, the converter's range, limits of
/// current and voltage, and the resonance. Throws Failure(bad_input) as rigid_axis(), and Failure(refused) if friction
/// and weight leave nothing for acceleration.
DriveLimits drive_limits(const sim::DriveDescription& model, const LimitWishes& wishes);

/// {"reserve", "drive": {"velocity": {"value", "by"}, …}, "written": {…}, "command_V", "limit_V", "not_counted"}.
nlohmann::json drive_limits_json(const DriveLimits& limits);

}  // namespace host
