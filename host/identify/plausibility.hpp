// Whether a drive can have the values of a model: asked in one place, whoever identified or fitted them.
#pragma once

#include <string>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// What no drive has, or what the records have not determined.
struct Doubt {
  std::string effect;   ///< kind
  std::string message;  ///< names the parameter and its value, says what it means and what to do
  bool refuses = true;  ///< no controller may be designed from it; else it is only to be said
};

/// Signs and ranges of all parameters; of the fitted ones also: on a bound of the fit, interval wider than the value;
/// friction against what the motor gives. Empty for a model that a drive can have.
std::vector<Doubt> doubts_of(const sim::DriveDescription& model);

/// Their messages, for the warnings of a command.
std::vector<std::string> messages_of(const std::vector<Doubt>& doubts);

/// Moves what lies outside its physical bounds onto them, without its interval, and says so: no reader of a model takes
/// such a value.
void keep_within_bounds(sim::EffectEntry& entry, sim::DriveKind kind, std::vector<std::string>& warnings);

/// Throws Failure(refused) with the first doubt that refuses, unless `accepted` names its effect.
void require_plausible(const sim::DriveDescription& model, const std::vector<std::string>& accepted);

}  // namespace host
