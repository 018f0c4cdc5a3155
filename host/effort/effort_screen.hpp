// Torque or force first, motion second: which effects the force balance needs, by evidence alone. No threshold decides
// but the losses of infer/posterior.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"
#include "host/effort/repeatability.hpp"

namespace host {

/// One effect that is certain.
struct CertainEffect {
  std::vector<std::string> group;    ///< one kind, or those that these data cannot tell apart, most probable first
  double probability = 0.0;          ///< of the group
  double before = 1.0, after = 1.0;  ///< RMS residual over RMS torque or force of the validation rows
};

struct EffortScreen {
  EffortRows rows;
  double effort_train = 0.0, effort_validate = 0.0;  ///< RMS, Nm or N
  ScreenedModel base;
  std::vector<std::vector<ScreenedModel>> steps;  ///< every kind tried on top of what was chosen so far, best first
  std::vector<ScreenedModel> chosen;              ///< one for each effect that is named
  std::vector<std::vector<std::string>> tied;     ///< of each chosen: kinds that these rows do not tell from it
  std::vector<CertainEffect> certain;             ///< in the order in which they were found, those not named too
  double nothing = 1.0;          ///< after the last step: probability that no effect of the catalogue follows
  double memory_log_odds = 0.0;  ///< that what is left depends on some coordinate, nats
  std::optional<Repeatability> repeatable;   ///< of the best model's residual, where a motion was repeated
  std::optional<ScreenedModel> judge_alone;  ///< the base fitted to the judging rows, its `train` of these
  std::vector<std::string> held;             ///< base parameters that stayed as given, and why, in words

  bool empty() const { return rows.size() == 0; }
  const ScreenedModel& best() const { return chosen.empty() ? base : chosen.back(); }
};

/// Chooses up to `most_effects`, never of the kinds in `absent`. Empty where the records hold no torque or force, or
/// hardly slide, or the model has no inverse.
EffortScreen screen_effort(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                           std::size_t most_effects, const std::vector<std::string>& absent = {});

/// The best model with one term more, and all that it held fitted again beside it. Nothing where a factor has no room
/// within physics.
std::optional<ScreenedModel> refitted_with(const EffortScreen& screen, const EffortTerm& term);

}  // namespace host
