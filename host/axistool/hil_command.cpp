// axistool hil: scenarios on the simulated machine.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/hil/fault_trial.hpp"
#include "host/hil/scenario_report.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct HilArguments {
  std::vector<std::string> scenarios;
  std::string output, json;
  bool fault_page = false;
};

void write_files(const host::Scenario& scenario, const host::ScenarioRun& run, const std::string& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) {
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: cannot make this folder: {}", folder, fault.message()));
  }
  const auto stem = std::filesystem::path(folder) / std::filesystem::path(scenario.path).stem();
  for (std::size_t i = 0; i < host::kMachineAxes; ++i)
    host::write_record(run.records[i], fmt::format("{}-{}.csv", stem.string(), host::kAxisNames[i]));
  host::scenario_report(scenario, run).write(stem.string() + ".html");
}

void run(const HilArguments& arguments) {
  if (arguments.fault_page) {
    fmt::print("{}", host::fault_page());
    return;
  }
  if (arguments.scenarios.empty())
    throw host::Failure(host::ExitCode::usage, "no scenario is named; the shipped ones are in host/hil/scenarios");
  nlohmann::json all = nlohmann::json::array();
  bool holds = true;
  for (const std::string& path : arguments.scenarios) {
    const host::Scenario scenario = host::read_scenario(path);
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
  command->add_option("SCENARIO", arguments->scenarios, "scenario files (axis-scenario/1)")->check(CLI::ExistingFile);
  command->add_option("-o,--output", arguments->output,
                      "folder for records (x, y) and an HTML report of each scenario");
  add_json_option(*command, arguments->json);
  command->add_flag("--fault-page", arguments->fault_page,
                    "inject every fault and print the page of faults and reactions (Markdown)");
  command->footer(
      "Examples:\n"
      "  axistool hil host/hil/scenarios/circle.toml -o build/hil\n"
      "  axistool hil host/hil/scenarios/*.toml --json -\n"
      "Exit code 1: something that a scenario expects does not hold. Equal scenarios give equal records, bit for bit.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
