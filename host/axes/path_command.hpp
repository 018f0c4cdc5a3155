// The largest command of each axis along a planned path, and its position (Erkorkmaz & Altintas 2001, p. 1490).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "host/device/path_run.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The drive described by an axis's parameters: sampled model, friction curve, cogging, converter; without weight and
/// limits of the amplifier. Empty if the parameters contain no model.
std::optional<sim::DriveDescription> drive_of_parameters(const firmware::AxisValues& values, std::string_view axis);

/// The point at which an axis needs the largest share of the available command.
struct CommandNeed {
  std::string axis;
  double command_V = 0.0, limit_V = 0.0;  ///< limit: that of the converter, or of the amplifier at this speed
  double time_s = 0.0;                    ///< time on the path
  std::size_t line = 0;                   ///< of the program
  double position_mm = 0.0, speed_mm_s = 0.0, acceleration_mm_s2 = 0.0;

  double share() const { return command_V / limit_V; }  ///< above 1: the axis cannot follow
};

/// Uses inverse models: inertia, friction, loads along the travel. `drives`: the drive of each coordinate; skips empty
/// ones. Ignores effects without an inverse.
std::vector<CommandNeed> largest_commands(const PlannedPath& path, const PathScale& scale,
                                          const std::vector<std::optional<sim::DriveDescription>>& drives);

/// [{"axis", "command_V", "limit_V", "share" (null: no command has an effect there), "time_s", "line", "position_mm",
/// "speed_mm_s", "acceleration_mm_s2"}].
nlohmann::json commands_json(const std::vector<CommandNeed>& needs);

}  // namespace host
