// The largest command that a planned path needs of each axis, and where (Erkorkmaz & Altintas 2001, p. 1490).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "host/device/path_run.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The drive that an axis' parameters describe: sampled model, friction curve, cogging, converter. Empty if they have
/// no model. Weight and limits of the amplifier are not among them.
std::optional<sim::DriveDescription> drive_of_parameters(const firmware::AxisValues& values, std::string_view axis);

/// Where an axis needs the largest share of the command that has an effect there.
struct CommandNeed {
  std::string axis;
  double command_V = 0.0, limit_V = 0.0;  ///< limit: converter, or amplifier at this speed
  double time_s = 0.0;                    ///< of the path
  std::size_t line = 0;                   ///< of the program
  double position_mm = 0.0, speed_mm_s = 0.0, acceleration_mm_s2 = 0.0;

  double share() const { return command_V / limit_V; }  ///< above 1: the axis cannot follow
};

/// By inverse models: inertia, friction, loads along the travel. `drives`: of each coordinate; those that are empty are
/// left out, and so are effects without an inverse.
std::vector<CommandNeed> largest_commands(const PlannedPath& path, const PathScale& scale,
                                          const std::vector<std::optional<sim::DriveDescription>>& drives);

/// [{"axis", "command_V", "limit_V", "share" (null: no command has an effect there), "time_s", "line", "position_mm",
/// "speed_mm_s", "acceleration_mm_s2"}].
nlohmann::json commands_json(const std::vector<CommandNeed>& needs);

}  // namespace host
