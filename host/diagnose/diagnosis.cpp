#include "host/diagnose/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host/diagnose/all_clear.hpp"
#include "host/diagnose/certainty.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/connection.hpp"
#include "host/diagnose/effort_diagnosis.hpp"
#include "host/diagnose/judgement.hpp"
#include "host/diagnose/table_evidence.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/exit_codes.hpp"
#include "host/fit/data_sheet_conflict.hpp"
#include "host/fit/model_fit.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/search/search_by_steps.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// A machine is limited by model error (rough) if half of the windows of the best model have an error of more than this
/// multiple of their noise floor.
constexpr double kRoughError = 10.0;

}  // namespace

bool is_rough(const SetError& error) {
  std::vector<double> squares;
  for (const WindowScore& score : error.windows) squares.push_back(std::max(score.x, score.w));
  if (squares.empty()) return false;
  return median(std::move(squares)) > kRoughError * kRoughError;
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

/// Diagnosis by a search over the effects, on sets whose base is fitted.
Diagnosis diagnose_by_search(PreparedSets sets, const sim::DriveDescription& model, const FigureRows& rows,
                             const EffortScreen* balance, const ShareDone& progress) {
  Diagnosis result(std::move(sets));
  result.rows = rows;
  const sim::Drive given(model);
  if (!result.moves_enough) {
    result.given_train = result.before_train = result.after_train = error_of(given, result.training).combined;
    result.given_validate = result.before_validate = result.after_validate =
        error_of(given, result.validation).combined;
    result.verdict = insufficient_data(model, result);
    return result;
  }
  if (progress) progress(0.05);
  SearchEffort effort{.windows = WindowCounts{}.over(result.window_s)};
  effort.nominal = &model;
  effort.balance = balance;
  effort.cut_short = &result.not_searched;
  const Findings found = search_by_steps(result, part_of(progress, 0.05, 0.95), effort);
  judge(result, model, found);
  if (progress) progress(1.0);
  return result;
}

/// Whether the regression used the speed channel for the motion and ignored the position.
bool ignores_position(const EffortRows& rows) { return rows.by_speed && rows.has_position; }

/// Whether the motion shows an effect that the force-balance regression cannot see.
bool goes_beyond(const Diagnosis& by_motion, const EffortScreen& screen) {
  const DiagnosisVerdict& verdict = by_motion.verdict;
  if ((by_motion.rough && !ignores_position(screen.rows)) || verdict.effects.empty()) return false;
  const auto seen = [&](const std::string& kind) {
    return std::ranges::any_of(screen.steps.front(),
                               [&](const ScreenedModel& tried) { return tried.kinds.back() == kind; });
  };
  return std::ranges::none_of(verdict.effects, seen);
}

/// Whether the motion shows effects that explain most of the squared error on both sets, while the force balance shows
/// none. Effects at reversals and of the encoder hardly change the torque or force while the axis slides.
bool explains_what_the_balance_does_not(const Diagnosis& by_motion, const Diagnosis& by_effort) {
  constexpr double kMost = 0.5;
  return by_effort.verdict.status == Status::unexplained && by_motion.verdict.status == Status::missing &&
         !by_motion.rough && explained_share(by_motion.before_train, by_motion.after_train) > kMost &&
         explained_share(by_motion.before_validate, by_motion.after_validate) > kMost;
}

/// Whether the motion can add to the effects of the regression: the residual exceeds noise, but the machine is not
/// limited by model error.
bool may_be_completed(const Diagnosis& by_effort, const RecordSet& validation) {
  const SetError left = error_of(sim::Drive(by_effort.best), validation);
  return left.combined > kExplained && !is_rough(left);
}

/// Whether the named effects leave only noise.
bool completes(const Diagnosis& by_motion) {
  return !by_motion.rough && !by_motion.verdict.effects.empty() &&
         std::max(by_motion.after_train, by_motion.after_validate) <= kExplained;
}

/// Whether the effects of the motion explain what those of the regression leave of the held-back records.
bool explains_what_remains(const Diagnosis& by_motion, const Diagnosis& by_effort) {
  const auto left = [](const Diagnosis& diagnosis) {
    return diagnosis.rows.error_of(diagnosis.best).validate.combined;
  };
  return by_motion.verdict.status == Status::missing && left(by_motion) < kExplainedPart * left(by_effort);
}

/// Whether one names an effect that the other does not.
bool names_more(const Diagnosis& one, const Diagnosis& other) {
  return !holds_all(other.verdict.effects, one.verdict.effects);
}

/// Whether the regression names all effects of the motion and more, and the motion's residual exceeds noise.
bool goes_further(const Diagnosis& by_effort, const Diagnosis& by_motion) {
  std::vector<std::string> known = by_effort.verdict.effects;
  for (const std::vector<std::string>& group : by_effort.verdict.alternatives)
    known.insert(known.end(), group.begin(), group.end());
  return by_motion.after_validate > kExplained && names_more(by_effort, by_motion) &&
         holds_all(known, by_motion.verdict.effects);
}

/// Joins the effects of the regression and the further ones of the motion in one diagnosis with the errors of the
/// motion. Effects that the regression cannot tell apart stay a group.
Diagnosis together(const sim::DriveDescription& given, Diagnosis by_effort, Diagnosis further) {
  const auto put_first = [](auto& list, const auto& first) { list.insert(list.begin(), first.begin(), first.end()); };
  const DiagnosisVerdict& first = by_effort.verdict;
  const bool is_tied = first.status == Status::ambiguous;
  const std::vector<std::string> known = is_tied ? std::vector{first.effects.front()} : first.effects;
  further.base = std::move(by_effort.base);
  const sim::Drive base(further.base), as_given(given);
  further.given_train = error_of(as_given, further.training).combined;
  further.given_validate = error_of(as_given, further.validation).combined;
  further.before_train = error_of(base, further.training).combined;
  further.before_validate = error_of(base, further.validation).combined;
  for (JudgedCandidate& candidate : further.candidates) {
    put_first(candidate.kinds, known);
    candidate.before = further.before_validate;
  }
  if (!is_tied) put_first(further.verdict.effects, known);
  put_first(further.verdict.alternatives, first.alternatives);
  further.verdict.explanation = first.explanation + " Beyond that: " + further.verdict.explanation;
  further.verdict.parameters = std::move(by_effort.verdict.parameters);
  return further;
}

/// Whether an effect changes the timing of the motor torque.
bool acts_late(const sim::EffectInfo& effect) {
  if (effect.stage != sim::Stage::command) return false;
  sim::EffectEntry entry{.kind = std::string(effect.kind), .parameters = {}, .ci95 = {}, .from = {}};
  for (const sim::ParameterInfo& parameter : effect.parameters)
    entry.parameters[std::string(parameter.id)] = parameter.starts.empty() ? parameter.upper : parameter.starts.front();
  sim::DriveDescription alone;
  sim::Drive drive(alone);
  effect.install(entry, alone.data, drive);
  return drive.delay_s > 0.0 || drive.current_lag_s > 0.0;
}

using Timed = std::shared_ptr<const std::vector<Record>>;

/// `timed`: receives the records that the diagnosis refers to, if they are not the measured ones.
Diagnosis diagnose_records(const sim::DriveDescription& given, const Measurements& measured, const ShareDone& progress,
                           const Diagnosis* before, const std::vector<std::string>& absent, Timed& timed) {
  if (progress) progress(0.01);
  const sim::DriveDescription model = with_measured_sensors(given, measured);
  std::vector<const Record*> training = measured.training_records(), validation = measured.validation_records();
  const bool by_short_windows = before != nullptr && before->rough;
  PreparedSets split;
  const auto prepare = [&] {
    if (!by_short_windows) split = split_sets(model, training, validation);
    split.absent = absent;
  };
  const auto time_beside = [&](const sim::DriveDescription& known) {
    std::vector<Record> copies = timed_beside(known, measured.all_records());
    if (copies.empty()) return false;
    timed = std::make_shared<const std::vector<Record>>(std::move(copies));
    for (std::size_t k = 0; k < timed->size(); ++k)
      (k < training.size() ? training[k] : validation[k - training.size()]) = &(*timed)[k];
    return true;
  };
  if (before != nullptr) time_beside(given);
  prepare();
  const FigureRows rows = before != nullptr ? before->rows : figure_rows(given, measured, &split);
  std::shared_ptr<const EffortScreen> screen, balance;
  const auto search_from = [&](PreparedSets sets, const sim::DriveDescription& from, const EffortScreen* starts) {
    sets.absent = absent;
    Diagnosis result = diagnose_by_search(std::move(sets), from, rows, starts, progress);
    result.log = measured.log();
    result.screen = screen;
    return result;
  };
  const auto search = [&](PreparedSets sets) { return search_from(std::move(sets), model, balance.get()); };
  if (!by_short_windows && split.moves_enough) balance = screen_of(model, split);
  // Diagnosis by the regression; empty if the search by motion must decide. `rough`: the motion has shown that the
  // machine is limited by model error and so cannot decide.
  const auto by_effort = [&](bool rough) -> std::optional<Diagnosis> {
    if (!split.moves_enough || (!has_linear_form(model) && !rough)) return {};
    if (!balance->empty()) screen = balance;
    if (balance->chosen.empty() && !effort_decides(*balance, split.validation)) return {};
    if (!balance->chosen.empty() && time_beside(balance->best().model)) prepare();
    Diagnosis diagnosis = diagnosis_of(model, split, balance);
    diagnosis.log = measured.log();
    diagnosis.rows = rows;
    if (progress) progress(1.0);
    return diagnosis;
  };
  // What the motion adds to the effects of the regression.
  const auto completed = [&](Diagnosis diagnosis) {
    PreparedSets on_top = split;
    on_top.base = diagnosis.best;
    Diagnosis further = search_from(with_base_fitted(std::move(on_top)), diagnosis.best, nullptr);
    const bool adds = !further.rough && further.verdict.status == Status::missing;
    return adds ? together(model, std::move(diagnosis), std::move(further)) : diagnosis;
  };
  std::optional<Diagnosis> over_long_windows, only_in_the_effort;
  // Returns the result of the regression if the motion is not explained.
  const auto unless_unexplained = [&](Diagnosis by_motion) {
    if (!only_in_the_effort) return by_motion;
    const bool explains =
        by_motion.verdict.status != Status::unexplained && !goes_further(*only_in_the_effort, by_motion);
    return explains ? std::move(by_motion) : *std::move(only_in_the_effort);
  };
  if (before == nullptr) {
    std::optional<Diagnosis> diagnosis = by_effort(false);
    if (diagnosis && !effort_decides(*screen, split.validation)) {
      only_in_the_effort = std::move(diagnosis);
    } else if (diagnosis) {
      const bool tells = !screen->chosen.empty();
      const bool ends_here = screen->rows.steady && (tells || !ignores_position(screen->rows));
      const bool is_open = tells && may_be_completed(*diagnosis, split.validation);
      if (ends_here || (tells && !is_open && is_explained(*screen))) return *std::move(diagnosis);
      // Effects that do not change the torque or force while the axis slides, such as a current limit, show in the
      // motion.
      over_long_windows = search(with_base_fitted(split));
      const bool is_better = tells ? explains_what_remains(*over_long_windows, *diagnosis) ||
                                         (completes(*over_long_windows) && names_more(*over_long_windows, *diagnosis))
                                   : goes_beyond(*over_long_windows, *screen) ||
                                         explains_what_the_balance_does_not(*over_long_windows, *diagnosis);
      if (is_better) return *std::move(over_long_windows);
      return is_open ? completed(*std::move(diagnosis)) : *std::move(diagnosis);
    }
  }
  if (!by_short_windows) {
    over_long_windows = search(with_base_fitted(split));
    if (!over_long_windows->rough) return unless_unexplained(*std::move(over_long_windows));
    if (before == nullptr && !screen)
      if (std::optional<Diagnosis> diagnosis = by_effort(true)) {
        if (explains_what_remains(*over_long_windows, *diagnosis)) return *std::move(over_long_windows);
        // With the effects of the balance, the motion may no longer be limited by model error.
        const bool ends_here =
            screen->chosen.empty() || screen->rows.steady || !may_be_completed(*diagnosis, split.validation);
        return ends_here ? *std::move(diagnosis) : completed(*std::move(diagnosis));
      }
  }
  const double short_s = rough_window_s(training);
  if ((before == nullptr || before->measure == Measure::effort) &&
      rough_measure(model, training, validation) == Measure::effort) {
    Diagnosis result = search(prepare_sets(model, training, validation, short_s, Measure::effort));
    const Status status = result.verdict.status;
    if (before != nullptr || status == Status::missing || status == Status::ambiguous) return result;
  }
  if (short_s < kWindow_s || !over_long_windows)
    return unless_unexplained(search(prepare_sets(model, training, validation, std::min(short_s, kWindow_s))));
  return unless_unexplained(*std::move(over_long_windows));
}

/// Kinds that are not candidates: effects that the machine is known not to have, delays that the logged torque or force
/// explains, and effects that a sensor on the table excludes.
std::vector<std::string> without_excluded(std::vector<std::string> absent, const Measurements& measured,
                                          const TableStudy* table) {
  if (timing_explains_delays(measured.training_records()))
    for (const sim::EffectInfo* effect : sim::catalogue())
      if (acts_late(*effect)) absent.emplace_back(effect->kind);
  if (table != nullptr)
    for (std::string& kind : absent_by_table(*table)) absent.push_back(std::move(kind));
  return absent;
}

void take_figures(const sim::DriveDescription& given, Diagnosis& diagnosis) {
  diagnosis.given_error = diagnosis.rows.error_of(given);
  diagnosis.base_error = diagnosis.moves_enough ? diagnosis.rows.error_of(diagnosis.base) : diagnosis.given_error;
  diagnosis.best_error =
      diagnosis.verdict.effects.empty() ? diagnosis.base_error : diagnosis.rows.error_of(diagnosis.best);
}

}  // namespace

Diagnosis diagnose(const sim::DriveDescription& given, const Measurements& measured, const ShareDone& progress,
                   const Diagnosis* before, const std::vector<std::string>& known_absent) {
  const std::shared_ptr<const TableStudy> table =
      before != nullptr ? before->table : std::make_shared<TableStudy>(study_table(given, measured.all_records()));
  const std::vector<std::string> absent = without_excluded(known_absent, measured, table.get());
  Timed timed;
  Diagnosis diagnosis = diagnose_records(given, measured, progress, before, absent, timed);
  diagnosis.timed = std::move(timed);
  diagnosis.table = table;
  const bool only_the_motor = table && table->empty();
  if (only_the_motor) compare_spring_with_gap_by_motion(diagnosis, given, measured, absent);
  take_figures(given, diagnosis);
  if (!diagnosis.moves_enough) return diagnosis;
  diagnosis.verdict.explanation += said_by_the_motion(diagnosis);
  if (only_the_motor) take_back_denied_connection(diagnosis);
  diagnosis.residual = test_residuals(diagnosis.best, diagnosis.training, diagnosis.validation);
  name_coordinate(diagnosis);
  fill_found(diagnosis);
  if (only_the_motor) diagnosis.verdict.next_experiment += advice_on_a_scale(diagnosis.verdict);
  if (table && before == nullptr) settle_by_table(*table, diagnosis);
  for (const DataSheetConflict& conflict : data_sheet_conflicts(diagnosis.best, diagnosis.training)) {
    diagnosis.verdict.data_sheet.push_back(conflict.words);
    diagnosis.verdict.explanation += " " + conflict.words;
  }
  return diagnosis;
}

namespace {

/// Says that nothing is missing if the force balance names no effect, leaves the decision to the motion, and the error
/// of the motion is at the noise floor.
bool is_clear_by_motion(Diagnosis& diagnosis) {
  const ErrorOnSets& error = diagnosis.base_error;
  DiagnosisVerdict& verdict = diagnosis.verdict;
  if (verdict.status != Status::unexplained || !verdict.effects.empty()) return false;
  if (error.train.combined > kSmall || error.validate.combined > kSmall) return false;
  verdict.status = verdict.parameters.empty() ? Status::adequate : Status::parameters;
  verdict.explanation = fmt::format(
      "The error is {:.2f} times the noise floor on validation data. First look, by the force balance alone, which "
      "finds no effect; the search by motion may find one.",
      error.validate.combined);
  verdict.next_experiment = "None needed for motions like these.";
  verdict.probability_nothing += std::exchange(verdict.probability_other, 0.0);
  return true;
}

}  // namespace

Diagnosis diagnose_quickly(const sim::DriveDescription& given, const Measurements& measured,
                           const std::vector<std::string>& known_absent) {
  const sim::DriveDescription model = with_measured_sensors(given, measured);
  PreparedSets split = split_sets(model, measured.training_records(), measured.validation_records());
  split.absent = without_excluded(known_absent, measured, nullptr);
  const FigureRows rows = figure_rows(given, measured, &split);
  if (!split.moves_enough) throw Failure(ExitCode::answer_is_no, "the axis moved too little for a first look");
  std::shared_ptr<const EffortScreen> screen = first_step_of(model, split);
  if (screen->empty())
    throw Failure(
        ExitCode::answer_is_no,
        "the records show no force balance (no torque or force, or hardly any sliding): a first look needs it");
  const bool decides = effort_decides(*screen, split.validation);
  Diagnosis diagnosis = diagnosis_of(model, split, std::move(screen));
  diagnosis.rows = rows;
  diagnosis.log = measured.log();
  take_figures(given, diagnosis);
  if (!decides && is_clear_by_motion(diagnosis)) return diagnosis;
  diagnosis.verdict.explanation = fmt::format(
      "First look, by the force balance alone{}. {}",
      decides ? "; the search by motion may change it" : ", whose residual is small here: the search by motion decides",
      diagnosis.verdict.explanation);
  name_coordinate(diagnosis);
  fill_found(diagnosis);
  return diagnosis;
}

}  // namespace host
