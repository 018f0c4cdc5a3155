// Which effects a force balance needs, by evidence alone: no threshold but the losses of infer/posterior.hpp. It runs
// beside effort_screen.hpp, which still decides, until no table of the scoreboard is worse by it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/effort/effort_hypotheses.hpp"
#include "host/effort/effort_regression.hpp"

namespace host {

/// One effect that is certain.
struct CertainEffect {
  std::vector<std::string> group;    ///< one kind, or those that these data cannot tell apart, most probable first
  double probability = 0.0;          ///< of the group
  double before = 1.0, after = 1.0;  ///< RMS residual over RMS torque or force of the validation rows
  bool named = false;                ///< takes at least kWorthNaming of the squared error there
};

struct EffortEvidence {
  std::vector<CertainEffect> certain;  ///< in the order in which they were found
  ScreenedModel base, best;            ///< without an effect, and with those that are named
  double nothing = 1.0;                ///< after the last step: probability that no effect of the catalogue follows
  double memory_log_odds = 0.0;        ///< that what is left depends on some coordinate, nats

  /// Kinds of what is named, one for each group.
  const std::vector<std::string>& effects() const { return best.kinds; }
};

/// Nothing where the records hold no torque or force, or hardly slide, or the model has no inverse.
std::optional<EffortEvidence> weigh_effects(const sim::DriveDescription& model, const RecordSet& training,
                                            const RecordSet& validation, const std::vector<std::string>& absent = {});

}  // namespace host
