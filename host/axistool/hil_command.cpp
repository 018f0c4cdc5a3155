// axistool hil: scenarios on the simulated machine.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/hil/fault_trial.hpp"
#include "host/hil/scenario_report.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct HilArguments {
  std::vector<std::string> scenarios, models;
  std::string output, json;
  bool fault_page = false;
};

std::string stem_of(const std::string& scenario, const std::string& folder) {
  return (std::filesystem::path(folder) / std::filesystem::path(scenario).stem()).string();
}

/// The files of a scenario are named after it: two of one name would overwrite each other's.
void check_names(const HilArguments& arguments) {
  std::map<std::string, std::string> taken;
  for (const std::string& path : arguments.scenarios) {
    const auto [other, is_new] = taken.emplace(stem_of(path, arguments.output), path);
    if (!is_new)
      throw host::Failure(host::ExitCode::usage,
                          fmt::format("{} and {} would write files of one name into {}: run them one at a time",
                                      other->second, path, arguments.output));
  }
}

void write_files(const host::Scenario& scenario, const host::ScenarioRun& run, const std::string& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) {
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: cannot make this folder: {}", folder, fault.message()));
  }
  const std::string stem = stem_of(scenario.path, folder);
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    host::write_record(run.records[i], fmt::format("{}-{}.csv", stem, host::kAxisNames[i]));
    host::write_model(run.believed[i], fmt::format("{}-{}.toml", stem, host::kAxisNames[i]));
  }
  host::scenario_report(scenario, run).write(stem + ".html");
}

/// "x=FILE": what the controller of this axis is told in place of what the scenario says.
void take_model(host::Scenario& scenario, const std::string& assignment) {
  const auto* const axis = std::ranges::find(host::kAxisNames, assignment.substr(0, assignment.find('=')));
  if (axis == host::kAxisNames.end() || assignment.find('=') == std::string::npos)
    throw host::Failure(host::ExitCode::usage, fmt::format("--model {}: write x=FILE or y=FILE", assignment));
  host::ScenarioAxis& told = scenario.axes[static_cast<std::size_t>(axis - host::kAxisNames.begin())];
  told.believed = host::read_model(assignment.substr(assignment.find('=') + 1));
  told.knowledge = host::Knowledge::model;
}

void run(const HilArguments& arguments) {
  if (arguments.fault_page) {
    fmt::print("{}", host::fault_page());
    return;
  }
  if (arguments.scenarios.empty())
    throw host::Failure(host::ExitCode::usage, "no scenario is named; the shipped ones are in host/hil/scenarios");
  if (!arguments.output.empty()) check_names(arguments);
  nlohmann::json all = nlohmann::json::array();
  bool holds = true;
  for (const std::string& path : arguments.scenarios) {
    host::Scenario scenario = host::read_scenario(path);
    for (const std::string& model : arguments.models) take_model(scenario, model);
    const host::ScenarioRun result = host::run_scenario(scenario);
    holds = holds && result.holds();
    if (!arguments.output.empty()) write_files(scenario, result, arguments.output);
    all.push_back(host::scenario_json(scenario, result));
    if (arguments.json == "-") continue;
    const host::Terminal terminal = host::terminal_of(stdout);
    fmt::print("{}", host::scenario_text(scenario, result, terminal));
    fmt::print("{}\n\n", result.holds() ? host::coloured("holds", host::Tone::good, terminal)
                                        : host::coloured("FAILS", host::Tone::bad, terminal));
  }
  if (!arguments.json.empty()) write_json(all.size() == 1 ? all.front() : all, arguments.json);
  if (!arguments.output.empty() && arguments.json != "-") fmt::print("Records and reports: {}\n", arguments.output);
  if (!holds) end_with(host::ExitCode::answer_is_no);
}

}  // namespace

void add_hil(CLI::App& app) {
  auto arguments = std::make_shared<HilArguments>();
  CLI::App* command = app.add_subcommand("hil", "run scenarios: the board's firmware around simulated drives");
  add_input(*command, "SCENARIO", arguments->scenarios, "scenario files (axis-scenario/1)")->check(CLI::ExistingFile);
  add_output(*command, "-o,--output", arguments->output,
             "folder for records (x, y), the controllers' models, and an HTML report of each scenario",
             FileRole::output_folder);
  add_input(*command, "--model", arguments->models,
            "x=FILE or y=FILE: design this axis's controller from this model instead")
      ->take_all();
  add_json_option(*command, arguments->json);
  command->add_flag("--fault-page", arguments->fault_page,
                    "inject every fault and print the page of faults and reactions (Markdown)");
  command->footer(
      "Examples:\n"
      "  axistool hil host/hil/scenarios/circle.toml -o build/hil\n"
      "  axistool hil host/hil/scenarios/*.toml --json -\n"
      "  axistool hil circle.toml --model x=better-x.toml --model y=better-y.toml\n"
      "Exit code 1: something that a scenario expects does not hold. Equal scenarios give equal records, bit for bit.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
