#include "host/diagnose/diagnosis_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/diagnose/diagnosis_figures.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/report/report.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

std::vector<ChannelError> errors_of(const Diagnosis& diagnosis) {
  return channel_errors(diagnosis.base_error.validate, diagnosis.best_error.validate, diagnosis.effort);
}

Verdict verdict_block(const Diagnosis& diagnosis, const std::vector<FoundEffect>& found) {
  const DiagnosisVerdict& verdict = diagnosis.verdict;
  Verdict block;
  const bool good = verdict.status == Status::adequate;
  const bool known = verdict.status == Status::missing || verdict.status == Status::parameters;
  block.tone = good                                    ? Tone::good
               : known                                 ? Tone::attention
               : verdict.status == Status::unexplained ? Tone::bad
                                                       : Tone::neutral;
  block.label = std::string(status_name(verdict.status));
  std::vector<std::string> titles;
  for (const std::string& kind : verdict.effects) titles.emplace_back(sim::find_effect(kind)->title);
  switch (verdict.status) {
    case Status::missing:
      block.headline = fmt::format("The model lacks: {}", fmt::join(titles, " and "));
      break;
    case Status::ambiguous:
      block.headline =
          fmt::format("Something is missing; these data cannot separate the candidates: {}", fmt::join(titles, " or "));
      break;
    case Status::parameters:
      block.headline =
          fmt::format("No effect is missing; these values were wrong: {}", fmt::join(verdict.parameters, ", "));
      break;
    case Status::adequate:
      block.headline = "The model explains these measurements";
      break;
    case Status::unexplained:
      block.headline = "No known effect explains the residual";
      break;
    case Status::insufficient_data:
      block.headline = "The axis moved too little for a diagnosis";
      break;
  }
  const bool ambiguous = verdict.status == Status::ambiguous;
  for (const FoundEffect& effect : found)
    block.sentences.push_back(fmt::format("{}{}.", ambiguous ? "If it is " : "", size_in_words(effect)));
  if (!found.empty()) block.sentences.push_back(errors_in_words(errors_of(diagnosis)));
  block.sentences.push_back(verdict.explanation);
  // Without a picture below it, these are what counts.
  std::vector<std::string>& later = found.empty() ? block.sentences : block.details;
  later.push_back("Next: " + verdict.next_experiment);
  for (const LogFault& fault : diagnosis.log)
    later.push_back(fmt::format("{}: {}.", fault.accepted ? "Accepted" : "Doubtful", fault.message));
  block.details.emplace_back(kNoiseFloorMeans);
  // An incomplete search does not matter if the named effects leave only noise.
  const bool is_explained = !verdict.effects.empty() && diagnosis.after_validate <= kExplained;
  if (!diagnosis.not_searched.empty() && !is_explained)
    block.details.push_back(fmt::format("Search incomplete (simulation budget exhausted) for: {}.",
                                        fmt::join(diagnosis.not_searched, ", ")));
  for (std::string& remedy : remedies(verdict.effects)) block.sentences.push_back(std::move(remedy));
  return block;
}

void add_errors(Report& report, const Diagnosis& diagnosis) {
  BarChart chart;
  chart.title = "Error in multiples of the noise floor";
  chart.caption = "All channels together.";
  chart.series = {{"train", SeriesRole::train}, {"validation", SeriesRole::validate}};
  chart.reference = {"noise floor", 1.0};
  const auto add = [&chart](const std::string& name, const ErrorOnSets& error) {
    chart.rows.push_back({name, {error.train.combined, error.validate.combined}, ""});
  };
  add("model as given", diagnosis.given_error);
  add("base re-fitted", diagnosis.base_error);
  if (!diagnosis.verdict.effects.empty())
    add(fmt::format("+ {}", fmt::join(diagnosis.verdict.effects, ", ")), diagnosis.best_error);
  report.add(error_table(errors_of(diagnosis), !diagnosis.verdict.effects.empty()));
  report.add(chart);
}

/// The effects that the verdict names, each in its best model; for an ambiguous verdict, each of the rivals.
std::vector<FoundEffect> found_by(const Diagnosis& diagnosis) {
  const DiagnosisVerdict& verdict = diagnosis.verdict;
  if (verdict.status != Status::ambiguous) return found_effects(diagnosis.best, verdict.effects, diagnosis);
  std::vector<FoundEffect> found;
  for (const JudgedCandidate& candidate : diagnosis.candidates) {
    const bool is_rival = candidate.kinds.size() == 1 &&
                          std::ranges::find(verdict.effects, candidate.kinds.front()) != verdict.effects.end();
    if (!is_rival) continue;
    for (FoundEffect& effect : found_effects(candidate.model, candidate.kinds, diagnosis))
      found.push_back(std::move(effect));
  }
  return found;
}

}  // namespace

Report diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name) {
  const bool added = !diagnosis.verdict.effects.empty();
  const std::vector<FoundEffect> found = found_by(diagnosis);
  Report report("Diagnosis of " + model_name, "Which physical effect is missing from the model");
  report.verdict(verdict_block(diagnosis, found));
  add_found(report, found, diagnosis.verdict.status == Status::ambiguous);
  if (diagnosis.verdict.status == Status::unexplained) add_unexplained(report, diagnosis);
  report.section("Size of the error", "");
  add_errors(report, diagnosis);
  if (!diagnosis.candidates.empty()) {
    report.section("What was tried");
    add_candidates(report, diagnosis);
  }
  add_residuals(report, diagnosis, diagnosis.best, added);
  add_whiteness(report, diagnosis);
  add_traces(report, diagnosis, diagnosis.best, added);
  return report;
}

void write_diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name, const std::string& path) {
  diagnosis_report(diagnosis, model_name).write(path);
}

}  // namespace host
