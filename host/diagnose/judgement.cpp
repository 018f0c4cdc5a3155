#include "host/diagnose/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "host/compare/chance.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/probability.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/record/columns.hpp"

namespace host {

namespace {

/// Windows of a set that follow one another within `span_s`.
std::size_t windows_in(double span_s, const RecordSet& set) {
  return std::max<std::size_t>(1,
                               static_cast<std::size_t>(std::lround(span_s / set.records.front().prepared.window_s())));
}

/// What a base and the best model leave on both sets.
struct FourErrors {
  SetError base_train, base_validate, best_train, best_validate;

  FourErrors(const Diagnosis& diagnosis, const RecordSet& training, const RecordSet& validation) {
    const sim::Drive base(diagnosis.base), best(diagnosis.best);
    base_train = error_of(base, training);
    base_validate = error_of(base, validation);
    best_train = error_of(best, training);
    best_validate = error_of(best, validation);
  }

  ChannelError channel(std::string_view name, double SetError::*rms, double SetError::*floor) const {
    return {std::string(name),  base_train.*rms,   base_validate.*rms,  best_train.*rms,
            best_validate.*rms, best_train.*floor, best_validate.*floor};
  }
};

}  // namespace

JudgedCandidate judge_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation,
                                const SetError& before, std::size_t tried) {
  constexpr double kBlock_s = 1.0;  // of the bootstrap
  const sim::Drive drive(candidate.model);
  const SetError after = error_of(drive, validation);
  JudgedCandidate judged;
  judged.kinds = candidate.kinds;
  judged.before = before.combined;
  judged.after = after.combined;
  const SetError train_after = error_of(drive, training);
  judged.train_after = train_after.combined;
  judged.train_after_robust = train_after.robust;
  judged.confidence =
      confidence_of_improvement(before, after, windows_in(kBlock_s, validation), validation.common_square);
  judged.luck =
      probability_of_luck(before, after, tried, windows_in(kLuckBlock_s, validation), validation.common_square);
  judged.model = candidate.model;
  judged.on_bound = parameters_on_bound(candidate.model, candidate.kinds);
  return judged;
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
  diagnosis.tried = findings.singles.size() + findings.pairs.size() + findings.triples.size();
  for (const std::vector<Candidate>* list : {&findings.singles, &findings.pairs, &findings.triples})
    for (const Candidate& candidate : *list)
      diagnosis.candidates.push_back(judge_candidate(candidate, training, validation, before, diagnosis.tried));
  std::ranges::stable_sort(diagnosis.candidates, {}, &JudgedCandidate::after);
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
  diagnosis.verdict = reach_verdict(given, diagnosis);
  assign_probabilities(diagnosis);
  diagnosis.best = diagnosis.base;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (std::ranges::is_permutation(candidate.kinds, diagnosis.verdict.effects)) diagnosis.best = candidate.model;
  if (diagnosis.verdict.status == Status::ambiguous) {
    for (const JudgedCandidate& candidate : diagnosis.candidates)
      if (candidate.kinds.size() == 1 && candidate.kinds.front() == diagnosis.verdict.effects.front())
        diagnosis.best = candidate.model;
  }

  const FourErrors judged(diagnosis, training, validation);
  diagnosis.after_train = judged.best_train.combined;
  diagnosis.after_validate = judged.best_validate.combined;
  const FourErrors seen = moves ? judged : FourErrors(diagnosis, seen_training, seen_validation);
  const auto name = [&](std::vector<double> Record::*channel) { return column_name(channel, given.data.kind); };
  const Record& record = *training.records.front().prepared.record;
  if (record.has_position())
    diagnosis.channels.push_back(seen.channel(name(&Record::x), &SetError::x_rms, &SetError::x_floor));
  if (record.has_speed())
    diagnosis.channels.push_back(seen.channel(name(&Record::w), &SetError::w_rms, &SetError::w_floor));
  if (!moves)
    diagnosis.channels.push_back(judged.channel(given.data.kind == sim::DriveKind::rotary ? "effort_Nm" : "effort_N",
                                                &SetError::effort_rms, &SetError::effort_floor));
}

}  // namespace host
