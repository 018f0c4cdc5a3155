// axistool hil: scenarios on the simulated machine.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/hil/before_after_report.hpp"
#include "host/hil/fault_trial.hpp"
#include "host/hil/scenario_index.hpp"
#include "host/hil/scenario_report.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "host/report/terminal.hpp"
#include "host/shipped_files.hpp"
#include "host/visible_text.hpp"

namespace axistool {

namespace {

struct HilArguments {
  std::vector<std::string> scenarios, models;
  std::string output, json;
  bool fault_page = false, list = false, before_after = false, allow_program = false;
};

/// Reads a scenario, and asks before it runs programs that the file names.
host::Scenario agreed_scenario(const std::string& path, const HilArguments& arguments) {
  host::Scenario scenario = host::read_scenario(path);
  for (const std::string& command : host::programs_of(scenario))
    require_consent(
        arguments.allow_program,
        fmt::format("{} runs this program on your computer: {}\nRun it?", path, host::visible_text(command)),
        "--allow-program");
  scenario.programs_allowed = true;
  return scenario;
}

std::string stem_of(const std::string& scenario, const std::string& folder) {
  return (std::filesystem::path(folder) / std::filesystem::path(scenario).stem()).string();
}

/// Throws if two scenarios have the same name: their files are named after them and would overwrite each other.
void check_names(const HilArguments& arguments) {
  std::map<std::string, std::string> taken;
  for (const std::string& path : arguments.scenarios) {
    const auto [other, is_new] = taken.emplace(stem_of(path, arguments.output), path);
    if (!is_new)
      throw host::Failure(host::ExitCode::usage,
                          fmt::format("{} and {} would write files of the same name into {}: run them one at a time",
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

/// "x=FILE": a model for this axis's controller, which replaces the scenario's.
host::ReplacedModel parse_model(const std::string& assignment) {
  const auto* const axis = std::ranges::find(host::kAxisNames, assignment.substr(0, assignment.find('=')));
  if (axis == host::kAxisNames.end() || assignment.find('=') == std::string::npos)
    throw host::Failure(host::ExitCode::usage, fmt::format("--model {}: write x=FILE or y=FILE", assignment));
  return {static_cast<std::size_t>(axis - host::kAxisNames.begin()), assignment.substr(assignment.find('=') + 1)};
}

host::Scenario with_models(host::Scenario scenario, const std::vector<host::ReplacedModel>& models) {
  for (const host::ReplacedModel& model : models) {
    scenario.axes[model.axis].believed = host::read_model(model.path);
    scenario.axes[model.axis].knowledge = host::Knowledge::model;
  }
  return scenario;
}

void print(const host::Scenario& scenario, const host::ScenarioRun& run) {
  const host::Terminal terminal = host::terminal_of(stdout);
  fmt::print("{}", host::scenario_text(scenario, run, terminal));
  const host::ScenarioOutcome outcome = host::outcome_of(run);
  fmt::print("{}\n\n", host::coloured(outcome.word, outcome.tone, terminal));
}

void list_shipped() {
  for (const std::string& name : host::shipped_scenarios())
    fmt::print("{:<32} {}\n", name, host::read_scenario(host::scenario_file(name)).name);
}

/// Runs the scenario unchanged and with the models of the command line; writes one page with both.
void run_before_and_after(const HilArguments& arguments, const std::vector<host::ReplacedModel>& models) {
  if (arguments.scenarios.size() != 1 || models.empty())
    throw host::Failure(host::ExitCode::usage, "--before-after needs one scenario, and --model for the new model");
  const host::Scenario scenario = agreed_scenario(arguments.scenarios.front(), arguments);
  const host::Scenario changed = with_models(scenario, models);
  const host::ScenarioRun before = host::run_scenario(scenario), after = host::run_scenario(changed);
  if (!arguments.output.empty()) {
    write_files(changed, after, arguments.output);
    host::before_after_report(scenario, before, after, models)
        .write(stem_of(scenario.path, arguments.output) + ".html");
  }
  if (!arguments.json.empty())
    write_json({{"format", "axis-hil-before-after/1"},
                {"before", host::scenario_json(scenario, before)},
                {"after", host::scenario_json(changed, after)}},
               arguments.json);
  if (arguments.json != "-") {
    print(changed, after);
    fmt::print("Before and after: {}\n", host::before_and_after(before, after));
    if (!arguments.output.empty()) fmt::print("Page: {}.html\n", stem_of(scenario.path, arguments.output));
  }
  if (!after.holds()) end_with(host::ExitCode::answer_is_no);
}

void run_all(const HilArguments& arguments, const std::vector<host::ReplacedModel>& models) {
  nlohmann::json all = nlohmann::json::array();
  std::vector<host::IndexLine> lines;
  std::vector<host::Scenario> scenarios;
  for (const std::string& path : arguments.scenarios)
    scenarios.push_back(with_models(agreed_scenario(path, arguments), models));
  for (const host::Scenario& scenario : scenarios) {
    const host::ScenarioRun result = host::run_scenario(scenario);
    const std::string page = std::filesystem::path(scenario.path).stem().string() + ".html";
    lines.push_back(host::index_line(scenario, result, page));
    if (!arguments.output.empty()) write_files(scenario, result, arguments.output);
    all.push_back(host::scenario_json(scenario, result));
    if (arguments.json != "-") print(scenario, result);
  }
  const bool several = lines.size() > 1;
  const std::string index = (std::filesystem::path(arguments.output) / "index.html").string();
  if (several && !arguments.output.empty()) host::scenario_index(lines).write(index);
  if (!arguments.json.empty()) write_json(several ? all : all.front(), arguments.json);
  if (arguments.json != "-") {
    if (several) fmt::print("{}", host::terminal_verdict(host::index_verdict(lines), host::terminal_of(stdout)));
    if (!arguments.output.empty())
      fmt::print("{}: {}\n", several ? "Pages" : "Page",
                 several ? index : stem_of(arguments.scenarios.front(), arguments.output) + ".html");
  }
  if (!std::ranges::all_of(lines, &host::IndexLine::holds)) end_with(host::ExitCode::answer_is_no);
}

void run(HilArguments& arguments) {
  if (arguments.fault_page) {
    fmt::print("{}", host::fault_page());
    return;
  }
  if (arguments.list) {
    list_shipped();
    return;
  }
  if (arguments.scenarios.empty())
    throw host::Failure(host::ExitCode::usage, "no scenario given; axistool hil --list lists the shipped ones");
  for (std::string& name : arguments.scenarios) name = host::scenario_file(name);
  std::vector<host::ReplacedModel> models;
  for (const std::string& assignment : arguments.models) models.push_back(parse_model(assignment));
  if (!arguments.output.empty()) check_names(arguments);
  if (arguments.before_after)
    run_before_and_after(arguments, models);
  else
    run_all(arguments, models);
}

}  // namespace

void add_hil(CLI::App& app) {
  auto arguments = std::make_shared<HilArguments>();
  CLI::App* command = app.add_subcommand("hil", "run scenarios: the board's firmware around simulated drives");
  add_input(*command, "SCENARIO", arguments->scenarios, "scenario files (axis-scenario/1), or names of shipped ones");
  add_output(*command, "-o,--output", arguments->output,
             "folder for records (x, y), the controllers' models, an HTML page for each scenario and one for all",
             FileRole::output_folder);
  add_input(*command, "--model", arguments->models,
            "x=FILE or y=FILE: design this axis's controller from this model instead")
      ->take_all();
  add_json_option(*command, arguments->json);
  command->add_flag("--list", arguments->list, "the shipped scenarios");
  command->add_flag("--before-after", arguments->before_after,
                    "also run it unchanged, and write one page of both: before, and after --model");
  command->add_flag("--allow-program", arguments->allow_program,
                    "run the external plant programs that scenarios name, without asking");
  command->add_flag("--fault-page", arguments->fault_page,
                    "inject every fault and print the table of faults and reactions (Markdown)");
  command->footer(
      "Examples:\n"
      "  axistool hil --list\n"
      "  axistool hil circle -o circle\n"
      "  axistool hil mine.toml square --json -\n"
      "  axistool hil hidden-effect --model x=better-x.toml --model y=better-y.toml --before-after -o after\n"
      "Exit code 1: an expectation of a scenario failed. The same scenario always gives the same records, bit for "
      "bit.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
