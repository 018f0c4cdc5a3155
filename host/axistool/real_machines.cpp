#include "host/axistool/real_machines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "host/axistool/insight_arguments.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "sim/harmonic.hpp"

namespace axistool {

namespace {

using Kinds = std::vector<std::string>;

struct Machine {
  std::string name;
  host::Diagnosis diagnosis;
  double seconds = 0.0;
  bool right = false;
  Kinds not_there;  ///< claimed, though it is known not to be there
};

bool holds_all(const Kinds& claimed, const Kinds& kinds) {
  return std::ranges::all_of(
      kinds, [&](const std::string& kind) { return std::ranges::find(claimed, kind) != claimed.end(); });
}

/// Right is an answer that is listed, or a group that holds one that is.
bool is_right(const host::DiagnosisVerdict& verdict, const std::vector<Kinds>& listed) {
  return std::ranges::any_of(listed, [&](const Kinds& kinds) {
    if (std::ranges::is_permutation(kinds, verdict.effects)) return true;
    return verdict.status == host::Status::ambiguous && !kinds.empty() && holds_all(verdict.effects, kinds);
  });
}

std::vector<std::string> paths_of(const nlohmann::json& names, const std::filesystem::path& folder) {
  std::vector<std::string> paths;
  for (const nlohmann::json& name : names) paths.push_back((folder / name.get<std::string>()).string());
  return paths;
}

Machine diagnosed(const std::string& name, const nlohmann::json& expected, const std::filesystem::path& folder) {
  const auto begin = std::chrono::steady_clock::now();
  InsightArguments arguments;
  arguments.model = (folder / "model.toml").string();
  arguments.train = paths_of(expected.at("train"), folder);
  arguments.validate = paths_of(expected.at("validate"), folder);
  arguments.accepted = expected.value("accept", std::vector<std::string>{});
  const InsightRecords records(arguments);
  Machine machine;
  machine.name = name;
  {
    SearchProgress progress(name);
    machine.diagnosis = host::diagnose(records.model, records.measurements, progress.callback());
  }
  machine.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  machine.right = is_right(machine.diagnosis.verdict, expected.at("right").get<std::vector<Kinds>>());
  for (const std::string& kind : expected.value("must_not", Kinds{}))
    if (holds_all(machine.diagnosis.verdict.effects, {kind})) machine.not_there.push_back(kind);
  return machine;
}

std::string percent(double relative) { return fmt::format("{:.1f}", 100.0 * relative); }

std::string orders_of(const host::Diagnosis& diagnosis) {
  std::string words;
  for (const sim::EffectEntry& entry : diagnosis.best.effects)
    if (entry.has("period"))
      for (const sim::HarmonicTerm& term : sim::harmonics_of(entry)) words += fmt::format(" {:g}", term.order);
  return words.empty() ? words : " orders" + words;
}

void print(const Machine& machine, std::size_t width) {
  const host::DiagnosisVerdict& verdict = machine.diagnosis.verdict;
  const host::EffortScreen* screen = machine.diagnosis.screen.get();
  fmt::print("{:<{}}  {:<5} {:>8} {:>8} {:6.1f}  {} {}{}{}\n", machine.name, width,
             machine.right && machine.not_there.empty() ? "right" : "wrong",
             screen == nullptr ? "-" : percent(screen->base.validate),
             screen == nullptr ? "-" : percent(screen->best().validate), machine.seconds,
             host::status_name(verdict.status), fmt::join(verdict.effects, ", "), orders_of(machine.diagnosis),
             machine.not_there.empty() ? "" : fmt::format("; not there: {}", fmt::join(machine.not_there, ", ")));
  std::fflush(stdout);
}

nlohmann::json to_json(const Machine& machine) {
  const host::Diagnosis& diagnosis = machine.diagnosis;
  nlohmann::json document = {{"machine", machine.name},
                             {"right", machine.right && machine.not_there.empty()},
                             {"not_there", machine.not_there},
                             {"status", std::string(host::status_name(diagnosis.verdict.status))},
                             {"effects", diagnosis.verdict.effects},
                             {"alternatives", diagnosis.verdict.alternatives},
                             {"seconds", machine.seconds}};
  if (diagnosis.screen)
    document["relative_error"] = {{"before", diagnosis.screen->base.validate},
                                  {"after", diagnosis.screen->best().validate}};
  return document;
}

nlohmann::json read_expected(const std::filesystem::path& file) {
  try {
    return nlohmann::json::parse(host::read_file(file.string())).at("machines");
  } catch (const nlohmann::json::exception& error) {
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: no object \"machines\" ({})", file.string(), error.what()));
  }
}

}  // namespace

void score_real_machines(const std::string& folder, const std::string& json) {
  const nlohmann::json machines = read_expected(std::filesystem::path(folder) / "expected.json");
  std::size_t width = 7;
  for (const auto& [name, expected] : machines.items()) width = std::max(width, name.size());
  const bool talks = json != "-";
  if (talks)
    fmt::print("{:<{}}  {:<5} {:>8} {:>8} {:>6}  {}\n", "machine", width, "", "before %", "after %", "s", "verdict");
  nlohmann::json rows = nlohmann::json::array();
  std::size_t right = 0;
  for (const auto& [name, expected] : machines.items()) {
    const Machine machine = diagnosed(name, expected, std::filesystem::path(folder) / name);
    if (talks) print(machine, width);
    rows.push_back(to_json(machine));
    right += machine.right && machine.not_there.empty() ? 1 : 0;
  }
  if (talks)
    fmt::print(
        "\n{} of {} right. Errors are of the effort on validation data, of least squares with inertia and friction "
        "before, with the verdict's effects after.\n",
        right, machines.size());
  if (!json.empty()) write_json({{"format", "axis-real-machines/1"}, {"machines", rows}}, json);
}

}  // namespace axistool
