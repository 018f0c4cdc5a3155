// axistool demo: identification, control and checks in one report.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/demo/demonstration.hpp"
#include "host/report/terminal.hpp"
#include "host/shipped_files.hpp"

namespace axistool {

namespace {

struct DemoArguments {
  std::string output = "axis-demo", emps, data = host::shipped_file("drive");
};

void run(const DemoArguments& arguments) {
  if (!std::filesystem::exists(arguments.data)) {
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: the shipped record is missing; name a folder with model.toml, "
                                    "train-steps.csv, validate.csv and truth.json with --data",
                                    arguments.data));
  }
  host::DemonstrationInput input{.drive_case = arguments.data, .emps_folder = {}};
  if (!arguments.emps.empty()) input.emps_folder = arguments.emps;
  const host::Demonstration shown = host::demonstrate(input);
  std::error_code fault;
  std::filesystem::create_directories(arguments.output, fault);
  if (fault) {
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: cannot make this folder: {}", arguments.output, fault.message()));
  }
  const std::string path = (std::filesystem::path(arguments.output) / "index.html").string();
  shown.report.write(path);

  const host::Terminal terminal = host::terminal_of(stdout);
  fmt::print("{}\n", host::terminal_table(host::figures_table(shown.figures), terminal));
  fmt::print("{}\n", shown.agrees()
                         ? host::coloured("Every figure agrees with its reference.", host::Tone::good, terminal)
                         : host::coloured("Some figures differ.", host::Tone::bad, terminal));
  if (arguments.emps.empty())
    fmt::print("The real EMPS drive was left out: give the folder of its public data set with --emps DIR.\n");
  fmt::print("Plots: {}\n", path);
  if (!shown.agrees()) end_with(host::ExitCode::answer_is_no);
}

}  // namespace

void add_demo(CLI::App& app) {
  auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command =
      app.add_subcommand("demo", "identify a shipped record, control the paper's axes, report with plots");
  add_output(*command, "-o,--output", arguments->output, "folder for the report, index.html", FileRole::output_folder)
      ->capture_default_str();
  command->add_option("--emps", arguments->emps, "folder with DATA_EMPS.mat and DATA_EMPS_PULSES.mat")
      ->check(CLI::ExistingDirectory);
  command->add_option("--data", arguments->data, "folder of the record, instead of the shipped one");
  command->footer(
      "Examples:\n"
      "  axistool demo\n"
      "  axistool demo -o emps --emps ~/Downloads/EMPS\n"
      "Exit code 1: a figure does not agree with its reference.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
