#include "host/diagnose/diagnosis_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/diagnose/diagnosis_figures.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/report/report.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

Verdict verdict_block(const Diagnosis& diagnosis) {
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
          fmt::format("Something is missing, and these data cannot tell which: {}", fmt::join(titles, " or "));
      break;
    case Status::parameters:
      block.headline =
          fmt::format("The structure is right; these values were off: {}", fmt::join(verdict.parameters, ", "));
      break;
    case Status::adequate:
      block.headline = "The model explains these measurements";
      break;
    case Status::unexplained:
      block.headline = "Something happens here that no effect of the catalogue explains";
      break;
    case Status::insufficient_data:
      block.headline = "The axis moved too little to say anything";
      break;
  }
  for (const LogFault& fault : diagnosis.log)
    block.sentences.push_back(fmt::format("{}: {}.", fault.accepted ? "Accepted" : "Doubtful", fault.message));
  block.sentences.push_back(verdict.explanation);
  block.sentences.push_back("Next: " + verdict.next_experiment);
  if (!diagnosis.not_searched.empty())
    block.sentences.push_back(fmt::format("Not searched to the end, their fits used up what a fit may simulate: {}.",
                                          fmt::join(diagnosis.not_searched, ", ")));
  if (!verdict.effects.empty())
    block.sentences.push_back("What to do about it: " + std::string(sim::find_effect(verdict.effects.front())->remedy));
  return block;
}

void add_errors(Report& report, const Diagnosis& diagnosis) {
  BarChart chart;
  chart.title = "Error over floor";
  chart.caption = "1 is what sensor noise and the restart leave to a perfect model.";
  chart.series = {{"train", SeriesRole::train}, {"validation", SeriesRole::validate}};
  chart.reference = {"floor", 1.0};
  chart.rows = {{"model as given", {diagnosis.given_train, diagnosis.given_validate}, ""},
                {"base re-fitted", {diagnosis.before_train, diagnosis.before_validate}, ""}};
  if (!diagnosis.verdict.effects.empty())
    chart.rows.push_back({fmt::format("+ {}", fmt::join(diagnosis.verdict.effects, ", ")),
                          {diagnosis.after_train, diagnosis.after_validate},
                          ""});
  report.add(chart);
}

}  // namespace

void write_diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name, const std::string& path) {
  Report report("Diagnosis of " + model_name, "Which physical effect is missing from the model");
  report.verdict(verdict_block(diagnosis));
  report.section("How large the error is", "");
  add_errors(report, diagnosis);
  if (!diagnosis.candidates.empty()) report.add(candidate_chart(diagnosis));
  add_residuals(report, diagnosis, diagnosis.best);
  add_whiteness(report, diagnosis);
  add_traces(report, diagnosis, diagnosis.best);
  report.write(path);
}

}  // namespace host
