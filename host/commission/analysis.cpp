// Compare, diagnose, improve; the axis is disabled meanwhile.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/commission/steps.hpp"
#include "host/compare/model_comparison.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/diagnosis_report.hpp"
#include "host/diagnose/improvement_report.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/model/model_file.hpp"
#include "host/read_file.hpp"
#include "host/record/edit_record.hpp"
#include "host/record/read_record.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

std::vector<std::string> paths(CommissionSession& session, const std::vector<std::string>& files) {
  std::vector<std::string> all;
  for (const std::string& file : files)
    all.push_back(session.folder().require(file, file == "steps.csv"          ? "identify"
                                                 : file.starts_with("ladder") ? "ladder"
                                                                              : "validate"));
  return all;
}

/// A record without the first moments of motion. The initial state of a spring, a gap or bristles is not recorded: on a
/// machine with two masses the first 0.1 s causes nine tenths of the true model's error.
Record settled_record(const std::string& path, double resolution) {
  constexpr double kMoved = 5.0;         // counts: more than the encoder's noise
  constexpr double kForgotten_s = 0.15;  // 0.1 s (sim::Drive::memory_s) plus the reach of the smoothing
  Record whole = read_record(path);
  const auto moves =
      std::ranges::find_if(whole.x, [&](double x) { return std::abs(x - whole.x.front()) > kMoved * resolution; });
  if (moves == whole.x.end()) return whole;
  const double from_s = whole.t_s[static_cast<std::size_t>(moves - whole.x.begin())] + kForgotten_s;
  if (from_s > whole.t_s[whole.size() / 2]) return whole;
  return cut_record(read_file(path, kRecordSize), path, from_s, whole.t_s.back());
}

Measurements settled(const sim::DriveDescription& model, const std::vector<std::string>& training,
                     const std::vector<std::string>& judging) {
  std::vector<Record> train, judge;
  for (const std::string& path : training) train.push_back(settled_record(path, model.data.encoder_resolution));
  for (const std::string& path : judging) judge.push_back(settled_record(path, model.data.encoder_resolution));
  return MeasurementGate(model).admit(std::move(train), std::move(judge));
}

std::string named(const DiagnosisVerdict& verdict) {
  return fmt::format("{}{}{}. {}", status_name(verdict.status), verdict.effects.empty() ? "" : ": ",
                     fmt::join(verdict.effects, verdict.status == Status::ambiguous ? " or " : " + "),
                     verdict.explanation);
}

/// The error with a second mass or bristles depends on their state at the start of a window: even the true model leaves
/// two or three noise floors. The diagnosis has already tried every further effect; a repetition would take minutes.
int rungs_for(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  return drive.has_second_mass() || drive.bristles.has_value() ? 1 : kMostRungs;
}

}  // namespace

Measurements read_measurements(CommissionSession& session, const sim::DriveDescription& model) {
  std::vector<std::string> training = paths(session, kTrainingFiles);
  for (const auto& step : session.folder().document().at("steps"))
    for (const auto& file : step.at("files"))
      if (const auto name = file.get<std::string>(); is_planned_run(name))
        training.push_back(session.folder().path(name));
  return settled(model, training, paths(session, kJudgingFiles));
}

CommissionStepResult compare_first(CommissionSession& session) {
  const Computing computing(session);
  const sim::DriveDescription given = read_model(session.folder().require("model.toml", "friction"));
  const Measurements measured = settled(given, paths(session, kJudgingFiles), {});
  std::vector<FigureRecord> counted;
  for (const Record* record : measured.training_records()) counted.push_back({record});
  const ModelComparison comparison =
      compare_model(with_measured_sensors(given, measured), measured, figure_set(given, counted, kWindow_s));
  session.folder().write_json("comparison.json", comparison_json(comparison));
  return {{"comparison.json"},
          fmt::format("The prediction error on the validation motions is {:.3g} times the noise floor.",
                      comparison.error.combined)};
}

CommissionStepResult diagnose_machine(CommissionSession& session) {
  const Computing computing(session);
  const std::string path = session.folder().require("model.toml", "friction");
  const sim::DriveDescription model = read_model(path);
  session.found = std::make_shared<CommissionFinding>(CommissionFinding{read_measurements(session, model), {}});
  session.found->diagnosis = diagnose(model, session.found->measured);
  const Diagnosis& diagnosis = session.found->diagnosis;
  session.folder().write_json("diagnosis.json", to_json(diagnosis));
  write_diagnosis_report(diagnosis, path, session.folder().path("diagnosis.html"));
  write_model(diagnosis.best, session.folder().path("diagnosed.toml"));
  return {{"diagnosis.json", "diagnosis.html", "diagnosed.toml"}, named(diagnosis.verdict)};
}

CommissionStepResult improve_model(CommissionSession& session) {
  const Computing computing(session);
  // If a run has decided, start from its answer.
  const bool is_decided = session.folder().document().value("decided", nlohmann::json()).is_array();
  const std::string path = is_decided ? session.folder().require("decided.toml", "separate")
                                      : session.folder().require("model.toml", "friction");
  const sim::DriveDescription model = read_model(path);
  std::optional<Measurements> anew;
  const bool is_known = !is_decided && session.found && session.folder().document().value("runs", 0) == 0;
  if (!is_known) anew = read_measurements(session, model);
  const Improvement improvement = is_known ? improve(model, session.found->measured, {}, {}, session.found->diagnosis,
                                                     rungs_for(session.found->diagnosis.best))
                                           : improve(model, *anew, {}, {}, {}, rungs_for(model));
  const std::string output = session.folder().path("improved.toml");
  write_model(improvement.model, output);
  const nlohmann::json document = to_json(improvement, output);
  session.folder().write_json("improvement.json", document);
  session.folder().put("error", document["error"]);
  write_improvement_report(improvement, {path, output}, session.folder().path("improvement.html"));
  return {{"improved.toml", "improvement.json", "improvement.html"},
          fmt::format("{:.3g} → {:.3g} times the noise floor; stopped because {}.",
                      improvement.first.given_error.validate.combined, improvement.error.validate.combined,
                      improvement.stopped_because)};
}

}  // namespace host
