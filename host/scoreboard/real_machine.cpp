#include "host/scoreboard/real_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "host/diagnose/verdict.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/read_file.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using Kinds = std::vector<std::string>;

bool holds_all(const Kinds& claimed, const Kinds& kinds) {
  return std::ranges::all_of(
      kinds, [&](const std::string& kind) { return std::ranges::find(claimed, kind) != claimed.end(); });
}

bool is_listed(const DiagnosisVerdict& verdict, const std::vector<Kinds>& listed) {
  return std::ranges::any_of(listed, [&](const Kinds& kinds) {
    if (std::ranges::is_permutation(kinds, verdict.effects)) return true;
    return verdict.status == Status::ambiguous && !kinds.empty() && holds_all(verdict.effects, kinds);
  });
}

std::vector<std::string> paths_of(const nlohmann::json& names, const std::filesystem::path& folder) {
  std::vector<std::string> paths;
  for (const nlohmann::json& name : names) paths.push_back((folder / name.get<std::string>()).string());
  return paths;
}

}  // namespace

std::vector<RealMachine> read_real_machines(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "expected.json";
  std::vector<RealMachine> machines;
  try {
    const nlohmann::json document = nlohmann::json::parse(read_file(file.string()));
    for (const auto& [name, expected] : document.at("machines").items())
      machines.push_back({name, (folder / name / "model.toml").string(), paths_of(expected.at("train"), folder / name),
                          paths_of(expected.at("validate"), folder / name), expected.value("accept", Kinds{}),
                          expected.at("right").get<std::vector<Kinds>>(), expected.value("must_not", Kinds{})});
  } catch (const nlohmann::json::exception& error) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: no object \"machines\" with train, validate and right for each "
                                                   "({})",
                                                   file.string(), error.what()));
  }
  return machines;
}

RealAnswer ask(const RealMachine& machine, const ShareDone& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const sim::DriveDescription model = read_model(machine.model);
  const Measurements measured = MeasurementGate(model, {machine.accepted}).read(machine.train, machine.validate);
  RealAnswer answer;
  answer.diagnosis = diagnose(model, measured, progress);
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  answer.listed = is_listed(answer.diagnosis.verdict, machine.right);
  for (const std::string& kind : machine.must_not)
    if (holds_all(answer.diagnosis.verdict.effects, {kind})) answer.not_there.push_back(kind);
  return answer;
}

std::vector<double> orders_of(const Diagnosis& diagnosis) {
  std::vector<double> orders;
  for (const sim::EffectEntry& entry : diagnosis.best.effects)
    if (entry.has("period"))
      for (const sim::HarmonicTerm& term : sim::harmonics_of(entry)) orders.push_back(term.order);
  return orders;
}

}  // namespace host
