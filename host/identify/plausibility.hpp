// Checks that the values of a model are physically possible, for all identification methods.
#pragma once

#include <string>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// A value that is impossible, or that the records do not determine.
struct Doubt {
  std::string effect;   ///< kind
  std::string message;  ///< with parameter, value, consequence and remedy
  bool refuses = true;  ///< true if no controller may be designed; otherwise a warning
};

/// Checks signs and ranges of all parameters. For fitted parameters also: on a bound of the fit, interval wider than
/// the value, friction larger than the motor's torque. Empty for a possible model.
std::vector<Doubt> doubts_of(const sim::DriveDescription& model);

/// The messages of the doubts, for the warnings of a command.
std::vector<std::string> messages_of(const std::vector<Doubt>& doubts);

/// Clips values to their physical bounds, because no reader of a model accepts values outside. Removes their intervals
/// and adds warnings.
void keep_within_bounds(sim::EffectEntry& entry, sim::DriveKind kind, std::vector<std::string>& warnings);

/// Throws Failure(refused) with the first doubt that forbids a design, unless `accepted` names its effect.
void require_plausible(const sim::DriveDescription& model, const std::vector<std::string>& accepted);

}  // namespace host
