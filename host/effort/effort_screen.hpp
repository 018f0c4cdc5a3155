// Selects the effects that the force balance needs by Bayesian evidence, before the motion is used. The only thresholds
// are the losses in infer/posterior.hpp.
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
  std::vector<std::string> group;    ///< one kind, or kinds that these data cannot tell apart, most probable first
  double probability = 0.0;          ///< probability that one kind of the group is present
  double before = 1.0, after = 1.0;  ///< RMS residual over RMS torque or force of the validation rows
};

struct EffortScreen {
  EffortRows rows;
  double effort_train = 0.0, effort_validate = 0.0;  ///< RMS torque or force, Nm or N
  ScreenedModel base;
  std::vector<std::vector<ScreenedModel>> steps;  ///< every kind tried beside those chosen so far, best first
  std::vector<ScreenedModel> chosen;              ///< one model for each named effect
  std::vector<std::vector<std::string>> tied;     ///< per chosen kind: kinds that these rows cannot tell from it
  std::vector<CertainEffect> certain;             ///< in the order of discovery, including effects that are not named
  double nothing = 1.0;          ///< probability after the last step that no further effect of the catalogue exists
  double memory_log_odds = 0.0;  ///< log odds that the residual depends on a coordinate, nats
  std::optional<Repeatability> repeatable;   ///< of the best model's residual, if a motion was repeated
  std::optional<ScreenedModel> judge_alone;  ///< base fitted to the validation rows; `train` is its error on them
  std::vector<std::string> held;             ///< base parameters held at the given value, with the reason

  bool empty() const { return rows.size() == 0; }
  const ScreenedModel& best() const { return chosen.empty() ? base : chosen.back(); }
  /// Whether sensor noise alone can explain the best model's residual on the validation rows.
  bool leaves_noise() const { return best().validate * effort_validate <= most_noise(rows, true); }
};

/// Chooses up to `most_effects`, without the kinds in `absent`. Empty if the records contain no torque or force or
/// hardly any sliding, or if the model has no inverse.
EffortScreen screen_effort(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                           std::size_t most_effects, const std::vector<std::string>& absent = {});

/// The best model with one more term, and all other terms fitted again. Empty if a factor exceeds its physical bounds.
std::optional<ScreenedModel> refitted_with(const EffortScreen& screen, const EffortTerm& term);

}  // namespace host
