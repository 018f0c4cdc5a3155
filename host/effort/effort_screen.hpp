// Effort first, motion second: plain least squares of the effort on what the axis did, with every effect of the
// catalogue that leaves a trace in it. An engineer's first page about a machine; the search must never know less.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/effort/effort_regression.hpp"
#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"
#include "host/effort/repeatability.hpp"
#include "host/effort/spring_hardening.hpp"

namespace host {

struct EffortScreen {
  EffortRows rows;
  double effort_train = 0.0, effort_validate = 0.0;  ///< RMS, Nm or N
  ScreenedModel base;
  std::vector<std::vector<ScreenedModel>> steps;  ///< every kind tried on top of what was chosen so far, best first
  std::vector<ScreenedModel> chosen;              ///< one a step that earned its place
  std::vector<std::vector<std::string>> tied;     ///< of each chosen: kinds that these rows do not tell from it
  bool contradicted = false;                      ///< what had been chosen, by the motion predicted forward
  std::optional<SpringHardening> hardening;       ///< of the spring that was chosen last
  std::optional<Repeatability> repeatable;        ///< of the best model's residual, where a motion was repeated
  std::optional<ScreenedModel> judge_alone;       ///< the base fitted to the judging rows, its `train` of these
  std::vector<std::string> held;                  ///< base parameters that stayed as given, and why, in words

  bool empty() const { return rows.size() == 0; }
  const ScreenedModel& best() const { return chosen.empty() ? base : chosen.back(); }
};

/// Chooses up to `most_steps` times, never of the kinds in `absent`. Empty where the records hold no effort, or hardly
/// slide.
EffortScreen screen_effort(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                           std::size_t most_steps = 3, const std::vector<std::string>& absent = {});

/// The best model with one term more, and all that it held fitted again beside it. Nothing where a factor has no room
/// within physics.
std::optional<ScreenedModel> refitted_with(const EffortScreen& screen, const EffortTerm& term);

}  // namespace host
