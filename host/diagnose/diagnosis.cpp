#include "host/diagnose/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host/diagnose/chance.hpp"
#include "host/diagnose/model_fit.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/record/columns.hpp"

namespace host {

namespace {

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

std::size_t windows_per_second(const RecordSet& set) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(1.0 / set.records.front().prepared.window_s())));
}

}  // namespace

JudgedCandidate judge_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation,
                                const SetError& before) {
  const sim::Drive drive(candidate.model);
  const SetError after = error_of(drive, validation);
  return {candidate.kinds,
          before.combined,
          after.combined,
          error_of(drive, training).combined,
          confidence_of_improvement(before, after, windows_per_second(validation), validation.common_square),
          candidate.model};
}

namespace {

/// Splits one progress into parts that follow one another.
ShareDone part(const ShareDone& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double share) { progress(from + share * (to - from)); };
}

}  // namespace

namespace {

/// A machine is rough when half of the windows of the best model lie this far above their floors.
constexpr double kRoughError = 10.0;

}  // namespace

bool is_rough(const SetError& error) {
  std::vector<double> squares;
  for (const WindowScore& score : error.windows) squares.push_back(std::max(score.x, score.w));
  if (squares.empty()) return false;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::ranges::nth_element(squares, middle);
  return *middle > kRoughError * kRoughError;
}

double rough_window_s(const std::vector<const Record*>& records) {
  constexpr double kShortest_s = 0.01, kLeastSamples = 10.0;
  return std::max(kShortest_s, kLeastSamples * records.front()->sample_period_s);
}

Measure rough_measure(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                      const std::vector<const Record*>& validation) {
  constexpr double kLeastSliding_s = 1.0;
  if (!has_inverse(sim::Drive(model))) return Measure::motion;
  for (const auto* records : {&training, &validation}) {
    if (records->empty()) continue;
    const double window_s = rough_window_s(*records);
    const RecordSet set = compare_on(*records, model, window_s, Measure::effort);
    if (static_cast<double>(set.used_windows()) * window_s < kLeastSliding_s) return Measure::motion;
  }
  return Measure::effort;
}

namespace {

/// Of all records: what recurs along the travel stands out more from several, what happened once stands out less.
RecordSet together(const RecordSet& training, const RecordSet& validation) {
  RecordSet all = training;
  all.records.insert(all.records.end(), validation.records.begin(), validation.records.end());
  return all;
}

Diagnosis diagnose_over(double window_s, Measure measure, const sim::DriveDescription& model,
                        const std::vector<const Record*>& training, const std::vector<const Record*>& validation,
                        const ShareDone& progress) {
  Diagnosis result(prepare_sets(model, training, validation, window_s, measure));
  const sim::Drive given(model);
  if (!result.moves_enough) {
    result.given_train = result.before_train = result.after_train = error_of(given, result.training).combined;
    result.given_validate = result.before_validate = result.after_validate =
        error_of(given, result.validation).combined;
    result.verdict = insufficient_data(model);
    return result;
  }
  if (progress) progress(0.05);
  const auto renew = [&](const sim::DriveDescription& reference) {
    renew_floors(result.training, reference);
    renew_floors(result.validation, reference);
  };

  SearchEffort effort = SearchEffort{}.over(window_s);
  effort.nominal = &model;
  std::vector<Candidate> singles =
      search_candidates(result.base, {}, result.training, result.validation, part(progress, 0.05, 0.5), effort);
  std::vector<Candidate> pairs;
  if (!singles.empty()) {
    renew(singles.front().model);
    const double left = error_of(sim::Drive(singles.front().model), result.validation).combined;
    if (left > kExplained) {
      pairs = search_candidates(singles.front().model, singles.front().kinds, result.training, result.validation,
                                part(progress, 0.5, 0.95), effort);
      if (!pairs.empty()) renew(pairs.front().model);
    }
  }

  const SetError before = error_of(sim::Drive(result.base), result.validation);
  for (const std::vector<Candidate>* list : {&singles, &pairs})
    for (const Candidate& candidate : *list)
      result.candidates.push_back(judge_candidate(candidate, result.training, result.validation, before));
  std::ranges::stable_sort(result.candidates, {}, &JudgedCandidate::after);
  result.before_train = error_of(sim::Drive(result.base), result.training).combined;
  result.before_validate = before.combined;
  result.given_train = error_of(given, result.training).combined;
  result.given_validate = error_of(given, result.validation).combined;
  const bool moves = measure == Measure::motion;
  const RecordSet seen_training = moves ? result.training : by_motion(result.training, result.base);
  const RecordSet seen_validation = moves ? result.validation : by_motion(result.validation, result.base);
  result.where = error_regions(result.base, together(seen_training, seen_validation));
  result.rough =
      is_rough(result.candidates.empty() ? before
                                         : error_of(sim::Drive(result.candidates.front().model), result.validation)) ||
      measure == Measure::effort || window_s < kWindow_s;
  result.verdict = reach_verdict(model, result);
  result.best = result.base;
  for (const JudgedCandidate& candidate : result.candidates)
    if (std::ranges::is_permutation(candidate.kinds, result.verdict.effects)) result.best = candidate.model;
  if (result.verdict.status == Status::ambiguous) {
    for (const JudgedCandidate& candidate : result.candidates)
      if (candidate.kinds.size() == 1 && candidate.kinds.front() == result.verdict.effects.front())
        result.best = candidate.model;
  }

  const FourErrors judged(result, result.training, result.validation);
  result.after_train = judged.best_train.combined;
  result.after_validate = judged.best_validate.combined;
  const FourErrors seen = moves ? judged : FourErrors(result, seen_training, seen_validation);
  const auto name = [&](std::vector<double> Record::*channel) { return column_name(channel, model.data.kind); };
  if (training.front()->has_position())
    result.channels.push_back(seen.channel(name(&Record::x), &SetError::x_rms, &SetError::x_floor));
  if (training.front()->has_speed())
    result.channels.push_back(seen.channel(name(&Record::w), &SetError::w_rms, &SetError::w_floor));
  if (!moves)
    result.channels.push_back(judged.channel(model.data.kind == sim::DriveKind::rotary ? "effort_Nm" : "effort_N",
                                             &SetError::effort_rms, &SetError::effort_floor));
  if (progress) progress(1.0);
  return result;
}

}  // namespace

Diagnosis diagnose(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                   const std::vector<const Record*>& validation, const ShareDone& progress, const Diagnosis* before) {
  const auto over = [&](double window_s, Measure measure) {
    return diagnose_over(window_s, measure, model, training, validation, progress);
  };
  std::optional<Diagnosis> over_long_windows;
  if (before == nullptr || !before->rough) {
    over_long_windows = over(kWindow_s, Measure::motion);
    if (!over_long_windows->rough) return *std::move(over_long_windows);
  }
  const double short_s = rough_window_s(training);
  if ((before == nullptr || before->measure == Measure::effort) &&
      rough_measure(model, training, validation) == Measure::effort) {
    Diagnosis result = over(short_s, Measure::effort);
    const Status status = result.verdict.status;
    if (before != nullptr || status == Status::missing || status == Status::ambiguous) return result;
  }
  if (short_s < kWindow_s || !over_long_windows) return over(std::min(short_s, kWindow_s), Measure::motion);
  return *std::move(over_long_windows);
}

}  // namespace host
