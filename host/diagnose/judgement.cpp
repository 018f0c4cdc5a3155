#include "host/diagnose/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "host/compare/chance.hpp"
#include "host/diagnose/certainty.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/probability.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/parallel.hpp"
#include "host/search/physical_range.hpp"

namespace host {

namespace {

/// The candidates of all steps. Of several fits of the same effects, only the best is kept.
std::vector<const Candidate*> all_of(const Findings& findings) {
  std::vector<const Candidate*> all;
  for (const std::vector<Candidate>* list : {&findings.singles, &findings.pairs, &findings.triples})
    for (const Candidate& candidate : *list) {
      const auto same = std::ranges::find_if(
          all, [&](const Candidate* other) { return std::ranges::is_permutation(other->kinds, candidate.kinds); });
      if (same == all.end())
        all.push_back(&candidate);
      else if (candidate.log_loss() < (*same)->log_loss())
        *same = &candidate;
    }
  return all;
}

/// Levels over the floors of `best`.
SetLevels levels_of(const SetError& train, const SetError& validate, const Candidate& best) {
  const auto level = [](const SetError& error, const SetError& least) {
    return std::max(1.0, least.robust) * std::exp(error.log_loss - least.log_loss);
  };
  return {level(train, best.training), level(validate, best.validation)};
}

void judge_candidates(Diagnosis& diagnosis, const std::vector<const Candidate*>& all, const Candidate& best,
                      const SetError& before) {
  diagnosis.tried = all.size();
  diagnosis.candidates.resize(all.size());
  for_each_in_parallel(all.size(), [&](std::size_t k) {
    JudgedCandidate& judged = diagnosis.candidates[k];
    judged = judge_candidate(*all[k], diagnosis.training, diagnosis.validation, before, all.size());
    judged.level = levels_of(all[k]->training, all[k]->validation, best);
    if (diagnosis.judged_as_compared()) judged.error = diagnosis.rows.error_of(judged.model);
  });
  for_each_in_parallel(all.size(), [&](std::size_t k) {
    JudgedCandidate& judged = diagnosis.candidates[k];
    for (std::size_t other = 0; other < all.size(); ++other)
      if (all[other]->kinds.size() <= judged.kinds.size() + 1 && is_better(diagnosis.candidates[other], judged, kTie))
        judged.suffices = std::min(judged.suffices, probability_of_luck(all[k]->validation, all[other]->validation,
                                                                        all.size(), diagnosis.validation));
  });
  std::ranges::stable_sort(diagnosis.candidates, {},
                           [](const JudgedCandidate& judged) { return Diagnosis::printed(judged).validate; });
}

}  // namespace

JudgedCandidate judge_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation,
                                const SetError& before, std::size_t tried) {
  constexpr double kBlock_s = 1.0;  // of the bootstrap
  JudgedCandidate judged;
  judged.kinds = candidate.kinds;
  judged.before = before.combined;
  judged.after = candidate.validation.combined;
  judged.train_after = candidate.training.combined;
  const std::vector<double>&without = before.window_log_loss, &with = candidate.validation.window_log_loss;
  judged.confidence = confidence_of_improvement(without, with, windows_in(kBlock_s, validation));
  judged.luck = probability_of_luck(before, candidate.validation, tried, validation);
  judged.model = candidate.model;
  judged.on_bound = unphysical_parameters(candidate.model, candidate.kinds, training);
  return judged;
}

void judge(Diagnosis& diagnosis, const sim::DriveDescription& given, const Findings& findings) {
  RecordSet& training = diagnosis.training;
  RecordSet& validation = diagnosis.validation;
  const Candidate base = judged({}, diagnosis.base, training, validation);
  const SetError &before = base.validation, &before_train = base.training;
  const std::vector<const Candidate*> all = all_of(findings);
  const auto likeliest = std::ranges::min_element(all, {}, &Candidate::log_loss);
  const Candidate& best = all.empty() || base.log_loss() < (*likeliest)->log_loss() ? base : **likeliest;
  renew_floors(training, best.model);
  renew_floors(validation, best.model);
  diagnosis.before_train = before_train.combined;
  diagnosis.before_validate = before.combined;
  diagnosis.base_level = levels_of(before_train, before, best);
  judge_candidates(diagnosis, all, best, before);
  diagnosis.given_train = error_over_own_floors(given, training).combined;
  diagnosis.given_validate = error_over_own_floors(given, validation).combined;
  const bool moves = diagnosis.measure == Measure::motion;
  const RecordSet seen_training = moves ? training : by_motion(training, diagnosis.base);
  const RecordSet seen_validation = moves ? validation : by_motion(validation, diagnosis.base);
  diagnosis.where = error_regions(diagnosis.base, together(seen_training, seen_validation));
  diagnosis.rough = is_rough(best.validation) || !moves || diagnosis.window_s < kWindow_s;
  diagnosis.base_error = diagnosis.rows.error_of(diagnosis.base);
  diagnosis.verdict = reach_verdict(given, diagnosis);
  assign_probabilities(diagnosis);
  settle_status(diagnosis);
  const std::vector<std::string> modelled = modelled_kinds(diagnosis);
  const auto named = std::ranges::find_if(
      all, [&](const Candidate* candidate) { return std::ranges::is_permutation(candidate->kinds, modelled); });
  const Candidate& after = named == all.end() ? base : **named;
  diagnosis.best = after.model;
  diagnosis.after_train = after.training.combined;
  diagnosis.after_validate = after.validation.combined;
  if (!moves)
    diagnosis.effort = {given.data.kind == sim::DriveKind::rotary ? "effort_Nm" : "effort_N",
                        before_train.effort_rms,
                        before.effort_rms,
                        after.training.effort_rms,
                        after.validation.effort_rms,
                        after.training.effort_floor,
                        after.validation.effort_floor};
}

}  // namespace host
