#include "host/diagnose/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "host/compare/chance.hpp"
#include "host/diagnose/certainty.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/probability.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/parallel.hpp"

namespace host {

namespace {

/// Number of windows of a set in `span_s` of motion.
std::size_t windows_in(double span_s, const RecordSet& set) {
  return std::max<std::size_t>(1,
                               static_cast<std::size_t>(std::lround(span_s / set.records.front().prepared.window_s())));
}

/// judge_candidate() from the errors on both sets.
JudgedCandidate judged_by(const Candidate& candidate, const SetError& train_after, const SetError& after,
                          const RecordSet& training, const RecordSet& validation, const SetError& before,
                          std::size_t tried) {
  constexpr double kBlock_s = 1.0;  // of the bootstrap
  JudgedCandidate judged;
  judged.kinds = candidate.kinds;
  judged.before = before.combined;
  judged.after = after.combined;
  judged.after_robust = after.robust;
  judged.train_after = train_after.combined;
  judged.train_after_robust = train_after.robust;
  judged.confidence =
      confidence_of_improvement(before, after, windows_in(kBlock_s, validation), validation.common_square);
  judged.luck =
      probability_of_luck(before, after, tried, windows_in(kLuckBlock_s, validation), validation.common_square);
  judged.model = candidate.model;
  judged.on_bound = unphysical_parameters(candidate.model, candidate.kinds, training);
  return judged;
}

/// The candidates of all steps. Of several fits of the same effects, only the best is kept.
std::vector<const Candidate*> all_of(const Findings& findings) {
  std::vector<const Candidate*> all;
  for (const std::vector<Candidate>* list : {&findings.singles, &findings.pairs, &findings.triples})
    for (const Candidate& candidate : *list) {
      const auto same = std::ranges::find_if(
          all, [&](const Candidate* other) { return std::ranges::is_permutation(other->kinds, candidate.kinds); });
      if (same == all.end())
        all.push_back(&candidate);
      else if (candidate.left < (*same)->left)
        *same = &candidate;
    }
  return all;
}

void judge_candidates(Diagnosis& diagnosis, const Findings& findings, const SetError& before) {
  const RecordSet &training = diagnosis.training, &validation = diagnosis.validation;
  const std::vector<const Candidate*> all = all_of(findings);
  diagnosis.tried = all.size();
  diagnosis.candidates.resize(all.size());
  std::vector<SetError> after(all.size());
  for_each_in_parallel(all.size(), [&](std::size_t k) {
    const sim::Drive drive(all[k]->model);
    after[k] = error_of(drive, validation);
    diagnosis.candidates[k] =
        judged_by(*all[k], error_of(drive, training), after[k], training, validation, before, all.size());
    if (diagnosis.judged_as_compared()) diagnosis.candidates[k].error = diagnosis.rows.error_of(all[k]->model);
  });
  for_each_in_parallel(all.size(), [&](std::size_t k) {
    for (std::size_t more = 0; more < all.size(); ++more)
      if (all[more]->kinds.size() == all[k]->kinds.size() + 1 && holds_all(all[more]->kinds, all[k]->kinds))
        diagnosis.candidates[k].suffices =
            std::min(diagnosis.candidates[k].suffices,
                     probability_of_luck(after[k], after[more], all.size(), windows_in(kLuckBlock_s, validation),
                                         validation.common_square));
  });
  std::ranges::stable_sort(diagnosis.candidates, {}, &JudgedCandidate::after);
}

}  // namespace

JudgedCandidate judge_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation,
                                const SetError& before, std::size_t tried) {
  const sim::Drive drive(candidate.model);
  return judged_by(candidate, error_of(drive, training), error_of(drive, validation), training, validation, before,
                   tried);
}

const sim::DriveDescription& best_found(const sim::DriveDescription& base, const Findings& findings) {
  if (!findings.triples.empty()) return findings.triples.front().model;
  if (!findings.pairs.empty()) return findings.pairs.front().model;
  return findings.singles.empty() ? base : findings.singles.front().model;
}

void judge(Diagnosis& diagnosis, const sim::DriveDescription& given, const Findings& findings) {
  RecordSet& training = diagnosis.training;
  RecordSet& validation = diagnosis.validation;
  const sim::DriveDescription& reference = best_found(diagnosis.base, findings);
  renew_floors(training, reference);
  renew_floors(validation, reference);
  const SetError before = error_of(sim::Drive(diagnosis.base), validation);
  judge_candidates(diagnosis, findings, before);
  const SetError before_train = error_of(sim::Drive(diagnosis.base), training);
  diagnosis.before_train = before_train.combined;
  diagnosis.before_train_robust = before_train.robust;
  diagnosis.before_validate = before.combined;
  diagnosis.given_train = error_of(sim::Drive(given), training).combined;
  diagnosis.given_validate = error_of(sim::Drive(given), validation).combined;
  const bool moves = diagnosis.measure == Measure::motion;
  const RecordSet seen_training = moves ? training : by_motion(training, diagnosis.base);
  const RecordSet seen_validation = moves ? validation : by_motion(validation, diagnosis.base);
  diagnosis.where = error_regions(diagnosis.base, together(seen_training, seen_validation));
  diagnosis.rough =
      is_rough(diagnosis.candidates.empty() ? before
                                            : error_of(sim::Drive(diagnosis.candidates.front().model), validation)) ||
      !moves || diagnosis.window_s < kWindow_s;
  diagnosis.base_error = diagnosis.rows.error_of(diagnosis.base);
  diagnosis.verdict = reach_verdict(given, diagnosis);
  assign_probabilities(diagnosis);
  settle_status(diagnosis);
  diagnosis.best = diagnosis.base;
  const std::vector<std::string> modelled = modelled_kinds(diagnosis);
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (std::ranges::is_permutation(candidate.kinds, modelled)) diagnosis.best = candidate.model;

  const sim::Drive best(diagnosis.best);
  const SetError after_train = error_of(best, training), after = error_of(best, validation);
  diagnosis.after_train = after_train.combined;
  diagnosis.after_validate = after.combined;
  if (!moves)
    diagnosis.effort = {given.data.kind == sim::DriveKind::rotary ? "effort_Nm" : "effort_N",
                        before_train.effort_rms,
                        before.effort_rms,
                        after_train.effort_rms,
                        after.effort_rms,
                        after_train.effort_floor,
                        after.effort_floor};
}

}  // namespace host
