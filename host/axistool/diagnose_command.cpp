// axistool diagnose: which physical effect is missing from a model.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "host/axistool/commands.hpp"
#include "host/axistool/insight_arguments.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/diagnosis_report.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/model/effect_forms.hpp"
#include "host/plan/plan_json.hpp"
#include "host/plan/posterior.hpp"

namespace axistool {

namespace {

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.3g} %", 100.0 * *share) : "-";
}

/// Prints the errors in the format of compare.
void print_errors(const host::Diagnosis& diagnosis) {
  fmt::print("Prediction error over noise floor (1 is perfect)   train  validation\n");
  const auto row = [](const char* name, const host::ErrorOnSets& error) {
    fmt::print("  {:<42} {:10.3f} {:10.3f}\n", name, error.train.combined, error.validate.combined);
  };
  row("model as given", diagnosis.given_error);
  row("base parameters re-fitted", diagnosis.base_error);
  row("with the effects above", diagnosis.best_error);
  const auto& before = diagnosis.base_error.validate.channels;
  for (const host::ChannelFigures& after : diagnosis.best_error.validate.channels)
    if (const auto same = std::ranges::find(before, after.name, &host::ChannelFigures::name); same != before.end())
      fmt::print("  {:<10} RMS on validation {:.4g} -> {:.4g} {} ({} -> {} of the signal), noise floor {:.4g}\n",
                 after.name, same->rms, after.rms, after.unit, percent(same->share), percent(after.share), after.floor);
  if (const auto& effort = diagnosis.effort)
    fmt::print("  {:<10} RMS on validation {:.4g} -> {:.4g}, noise floor {:.4g}: the candidates are ranked by this\n",
               effort->name, effort->before_validate, effort->after_validate, effort->floor_validate);
}

void print(const host::Diagnosis& diagnosis) {
  print_log(diagnosis.log);
  const host::DiagnosisVerdict& verdict = diagnosis.verdict;
  fmt::print("Verdict: {}{}{}\n  {}\n", host::status_name(verdict.status), verdict.effects.empty() ? "" : ": ",
             fmt::join(verdict.effects, verdict.status == host::Status::ambiguous ? " or " : " + "),
             verdict.explanation);
  if (!verdict.parameters.empty()) fmt::print("  Wrong base parameters: {}\n", fmt::join(verdict.parameters, ", "));
  fmt::print("  Next: {}\n\n", verdict.next_experiment);
  if (diagnosis.held_back)
    fmt::print("No --validate: one of {} blocks of {:.2g} s of motion was held back for validation.\n",
               diagnosis.blocks.every, diagnosis.blocks.block_s);
  const bool is_explained = !verdict.effects.empty() && diagnosis.after_validate <= host::kExplained;
  if (!diagnosis.not_searched.empty() && !is_explained)  // as on the page
    fmt::print("Search incomplete (simulation budget exhausted) for: {}\n", fmt::join(diagnosis.not_searched, ", "));
  print_errors(diagnosis);
  if (diagnosis.candidates.empty()) return;
  fmt::print("\n  {:<50} {:>9} {:>9} {:>11} {:>10}\n", "candidate", "train", "validate", "probability", "not chance");
  constexpr std::size_t kShown = 8;
  for (std::size_t k = 0; k < std::min(kShown, diagnosis.candidates.size()); ++k) {
    const host::JudgedCandidate& candidate = diagnosis.candidates[k];
    fmt::print("  {:<50} {:9.3f} {:9.3f} {:10.1f}% {:9.1f}%\n", fmt::format("{}", fmt::join(candidate.kinds, " + ")),
               host::Diagnosis::printed(candidate).train, host::Diagnosis::printed(candidate).validate,
               100.0 * candidate.probability, 100.0 * candidate.confidence);
  }
  fmt::print("  {:<50} {:9.3f} {:9.3f} {:10.1f}%\n", "nothing is missing",
             diagnosis.printed_base().train, diagnosis.printed_base().validate,
             100.0 * verdict.probability_nothing);
  fmt::print("  {:<50} {:>9} {:>9} {:10.1f}%\n", "something else", "", "", 100.0 * verdict.probability_other);
}

struct DiagnoseArguments : InsightArguments {
  std::string beliefs;  ///< file with the JSON of plan or diagnose
  bool quick = false;
};

void run(const DiagnoseArguments& arguments) {
  for (const std::string& kind : arguments.absent) host::known_effect(kind);
  const InsightRecords records(arguments);
  std::optional<host::Beliefs> beliefs;
  std::optional<host::Decision> decision;
  if (!arguments.beliefs.empty()) {
    beliefs = host::read_beliefs(arguments.beliefs);
    decision = host::decide(records.model, *beliefs, records.measurements);
  }
  host::Diagnosis diagnosis;
  if (arguments.quick) {
    diagnosis = host::diagnose_quickly(records.model, records.measurements, arguments.absent);
  } else {
    SearchProgress progress("diagnose");
    diagnosis = host::diagnose(records.model, records.measurements, progress.callback(), nullptr, arguments.absent);
  }
  if (decision) host::apply(*decision, *beliefs, diagnosis);
  if (!arguments.report.empty()) host::write_diagnosis_report(diagnosis, arguments.model, arguments.report);
  if (!arguments.json.empty()) {
    nlohmann::json document = host::to_json(diagnosis);
    if (decision) document["decision"] = host::to_json(*decision);
    write_json(document, arguments.json);
  }
  if (arguments.json != "-") print(diagnosis);
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command =
      app.add_subcommand("diagnose", "find which physical effect is missing from a model, and how certain that is");
  arguments->add_to(*command);
  add_output(*command, "--report", arguments->report, "write a self-contained HTML report to this file");
  add_input(*command, "--believed", arguments->beliefs,
            "prior odds: the JSON that plan or diagnose wrote before a planned run that is among --train");
  command
      ->add_flag("--quick", arguments->quick,
                 "a first look by force-balance regression alone, without fitting effects to the motion")
      ->excludes("--believed");
  command->footer(
      "Example:\n"
      "  axistool diagnose x.toml --train steps.csv jog.csv --validate other.csv --report x.html\n"
      "After a planned run (`axistool plan`, `excite x run.toml -o run.csv`), whose odds decide:\n"
      "  axistool diagnose x.toml --train steps.csv jog.csv run.csv --believed plan.json\n"
      "Exit code 0 for any verdict; 9 for a bad file.");
  command->callback(
      [arguments] { with_log_of_failure(arguments->json, "axis-diagnosis/1", [&] { run(*arguments); }); });
}

}  // namespace axistool
