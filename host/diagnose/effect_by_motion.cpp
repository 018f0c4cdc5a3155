#include "host/diagnose/effect_by_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/exit_codes.hpp"
#include "host/search/candidate_starts.hpp"
#include "host/search/further_waves.hpp"

namespace host {

namespace {

std::optional<EffectByMotion> fitted_on(PreparedSets sets, const sim::EffectInfo& effect,
                                        const sim::DriveDescription& nominal, const EffortScreen* balance) {
  if (!sets.moves_enough)
    throw Failure(ExitCode::refused, fmt::format("{}: fitting and validating it needs {:.1f} s more motion",
                                                 effect.kind, std::max(0.1, missing_motion_s(sets))));
  if (!is_applicable(effect, sets.base, sets.training))
    throw Failure(ExitCode::usage,
                  fmt::format("{}: cannot be added: the model already has it (perhaps in another form) or excludes it, "
                              "or these records lack the channel that shows it",
                              effect.kind));
  SearchEffort effort{.windows = WindowCounts{}.over(sets.window_s)};
  effort.nominal = &nominal;
  effort.balance = balance;
  std::vector<Candidate> found = search_kinds({&effect}, sets.base, {}, sets.training, sets.validation, {}, effort);
  if (found.empty()) return {};
  add_further_waves(found.front(), sets);
  return EffectByMotion{std::move(sets), std::move(found.front())};
}

}  // namespace

std::optional<EffectByMotion> fit_effect_by_motion(const sim::EffectInfo& effect, const sim::DriveDescription& model,
                                                   const Measurements& measured, const PreparedSets& fitted,
                                                   const EffortScreen* balance) {
  std::optional<EffectByMotion> found = fitted_on(fitted, effect, model, balance);
  if (!found || !is_rough(error_of(sim::Drive(found->best.model), found->sets.validation))) return found;
  const std::vector<const Record*> training = measured.training_records(), validation = measured.validation_records();
  return fitted_on(prepare_sets(model, training, validation, rough_window_s(training),
                                rough_measure(found->best.model, training, validation)),
                   effect, model, balance);
}

}  // namespace host
