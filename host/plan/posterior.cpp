#include "host/plan/posterior.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

[[noreturn]] void refuse_belief(const std::string& path, const std::string& what) {
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: {}; give the --json file of `axistool plan` or of an ambiguous `axistool diagnose`",
                            path, what));
}

/// Takes the candidates that a diagnosis could not tell apart.
void take_diagnosis(const nlohmann::json& document, Beliefs& beliefs) {
  const auto effects = document.at("verdict").at("effects").get<std::vector<std::string>>();
  if (document.at("verdict").at("status") != "ambiguous") return;
  for (const auto& candidate : document.at("candidates")) {
    const auto kinds = candidate.at("kinds").get<std::vector<std::string>>();
    if (kinds.size() == 1 && std::ranges::find(effects, kinds.front()) != effects.end())
      beliefs.rivals.push_back({kinds, {}, candidate.at("probability").get<double>()});
  }
}

}  // namespace

Beliefs read_beliefs(const std::string& path) {
  const auto document = nlohmann::json::parse(read_file(path), nullptr, false);
  if (document.is_discarded() || !document.is_object()) refuse_belief(path, "not a JSON document");
  Beliefs beliefs;
  try {
    const auto format = document.at("format").get<std::string>();
    if (format == "axis-diagnosis/1") {
      take_diagnosis(document, beliefs);
    } else if (format == "axis-plan/1" || format == "axis-decision/1") {
      for (std::size_t k = 0; k < document.at("rivals").size(); ++k)
        beliefs.rivals.push_back({document["rivals"][k].get<std::vector<std::string>>(),
                                  {},
                                  document.at("probabilities").at(k).get<double>()});
      beliefs.expected_odds = document.value("expected_odds", 0.0);
    } else {
      refuse_belief(path, fmt::format("'{}' contains no prior odds", format));
    }
  } catch (const nlohmann::json::exception& error) {
    refuse_belief(path, error.what());
  }
  double sum = 0.0;
  for (const Rival& rival : beliefs.rivals) sum += rival.probability;
  if (beliefs.rivals.size() < 2 || !(sum > 0.0)) refuse_belief(path, "it leaves only one explanation");
  for (Rival& rival : beliefs.rivals) rival.probability /= sum;
  return beliefs;
}

bool is_planned_run(const Record& record) {
  const auto kind = record.header.find("excitation");
  return kind != record.header.end() && kind->second == "plan";
}

Decision decide(const sim::DriveDescription& model, const Beliefs& beliefs, const Measurements& measured) {
  std::vector<const Record*> before, runs;
  for (const Record* record : measured.training_records()) (is_planned_run(*record) ? runs : before).push_back(record);
  for (const Record* record : measured.validation_records()) before.push_back(record);
  if (runs.empty() || before.empty())
    throw Failure(ExitCode::usage,
                  runs.empty() ? "none of the training records is a planned run; make one with `axistool excite AXIS "
                                 "RUN.toml -o run.csv`, and give it together with the records used for the plan"
                               : "all training records are planned runs; also give the records used for the plan");
  std::vector<std::vector<std::string>> kinds;
  for (const Rival& rival : beliefs.rivals) kinds.push_back(rival.kinds);
  std::vector<Rival> rivals = fit_rivals(model, before, kinds);
  for (std::size_t k = 0; k < rivals.size(); ++k) rivals[k].probability = beliefs.rivals[k].probability;
  return decide_on(rivals, common_ground(before, rivals), common_ground(runs, rivals));
}

void apply(const Decision& decision, const Beliefs& beliefs, Diagnosis& diagnosis) {
  DiagnosisVerdict& verdict = diagnosis.verdict;
  if (!decision.explains) {
    verdict.explanation += fmt::format(
        " The planned run does not decide: even {} leaves {:.2g} times the noise floor, so the run shows something "
        "outside all rivals.",
        rival_name(decision.rivals[decision.best].kinds), decision.error);
    return;
  }
  double shared = 0.0;
  bool names_one = false;
  for (const Rival& rival : decision.rivals) {
    names_one = names_one || (!verdict.effects.empty() && rival.kinds.front() == verdict.effects.front());
    for (const JudgedCandidate& candidate : diagnosis.candidates)
      if (candidate.kinds == rival.kinds) shared += candidate.probability;
  }
  for (const Rival& rival : decision.rivals)
    for (JudgedCandidate& candidate : diagnosis.candidates)
      if (candidate.kinds == rival.kinds) candidate.probability = shared * rival.probability;
  std::vector<std::string> left;
  for (const std::size_t k : decision.left) left.push_back(rival_name(decision.rivals[k].kinds));
  verdict.explanation += fmt::format(
      " The planned run leaves {} with odds of {}{}.", fmt::join(left, " or "), odds_text(decision.odds),
      beliefs.expected_odds > 0.0 ? fmt::format(", where {} were expected", odds_text(beliefs.expected_odds))
                                  : std::string());
  const Rival& best = decision.rivals[decision.best];
  const bool speaks = verdict.status == Status::missing || verdict.status == Status::ambiguous;
  if (!names_one || !speaks) return;
  verdict.alternatives.clear();
  verdict.status = Status::missing;
  verdict.effects = best.kinds;
  diagnosis.best = best.model;
  diagnosis.best_error = diagnosis.rows.error_of(best.model);
  if (decision.left.size() < 2) return;
  verdict.status = Status::ambiguous;
  verdict.effects = left;
  verdict.alternatives.push_back(left);
}

}  // namespace host
