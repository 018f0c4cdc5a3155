// Force balance first, motion second: selects the effects that the force balance needs by evidence. The only thresholds
// are the losses of infer/posterior.hpp.
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
  std::vector<std::string> group;    ///< one kind, or those that these data do not separate, most probable first
  double probability = 0.0;          ///< of the group
  double before = 1.0, after = 1.0;  ///< RMS residual over RMS torque or force of the validation rows
};

struct EffortScreen {
  EffortRows rows;
  double effort_train = 0.0, effort_validate = 0.0;  ///< RMS, Nm or N
  ScreenedModel base;
  std::vector<std::vector<ScreenedModel>> steps;  ///< every kind tried in addition to those chosen so far, best first
  std::vector<ScreenedModel> chosen;              ///< one for each named effect
  std::vector<std::vector<std::string>> tied;  ///< of each chosen kind: those that these rows do not separate from it
  std::vector<CertainEffect> certain;          ///< in the order in which they were found, including unnamed ones
  double nothing = 1.0;          ///< after the last step: probability that no effect of the catalogue follows
  double memory_log_odds = 0.0;  ///< that the residual depends on some coordinate, nats
  std::optional<Repeatability> repeatable;   ///< of the best model's residual, where a motion was repeated
  std::optional<ScreenedModel> judge_alone;  ///< the base fitted to the validation rows; its `train` refers to these
  std::vector<std::string> held;             ///< base parameters that kept the given value, with the reason in words

  bool empty() const { return rows.size() == 0; }
  const ScreenedModel& best() const { return chosen.empty() ? base : chosen.back(); }
  /// Whether sensor noise alone can explain the best model's residual on the validation rows.
  bool leaves_noise() const { return best().validate * effort_validate <= most_noise(rows, true); }
};

/// Chooses up to `most_effects`, without the kinds in `absent`. Empty if the records hold no torque or force, hardly
/// slide, or the model has no inverse.
EffortScreen screen_effort(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                           std::size_t most_effects, const std::vector<std::string>& absent = {});

/// The best model with one more term, with all others re-fitted. Empty if a factor has no value within physical bounds.
std::optional<ScreenedModel> refitted_with(const EffortScreen& screen, const EffortTerm& term);

}  // namespace host
