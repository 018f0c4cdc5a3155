// Checks that a model's values are physically possible, in one place for all identification methods.
#pragma once

#include <string>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// A value that is impossible, or that the records do not determine.
struct Doubt {
  std::string effect;   ///< kind
  std::string message;  ///< names the parameter, its value, the consequence and the remedy
  bool refuses = true;  ///< no controller may be designed from it; otherwise only a warning
};

/// Signs and ranges of all parameters; of the fitted ones also: on a bound of the fit, interval wider than the value;
/// friction against the motor's torque. Empty for a possible model.
std::vector<Doubt> doubts_of(const sim::DriveDescription& model);

/// Their messages, for the warnings of a command.
std::vector<std::string> messages_of(const std::vector<Doubt>& doubts);

/// Clips values to their physical bounds, removes their intervals, and warns: no reader of a model accepts values
/// outside.
void keep_within_bounds(sim::EffectEntry& entry, sim::DriveKind kind, std::vector<std::string>& warnings);

/// Throws Failure(refused) with the first doubt that refuses, unless `accepted` names its effect.
void require_plausible(const sim::DriveDescription& model, const std::vector<std::string>& accepted);

}  // namespace host
