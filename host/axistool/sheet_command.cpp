// axistool sheet: a data sheet to fill in.
#include <fmt/format.h>

#include <memory>

#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/model/sheet_text.hpp"

namespace axistool {

namespace {

struct SheetArguments {
  std::string name, kind, effort = "current", path;
  double constant = 0.0, lead = 0.0, step = 0.0, period_s = 0.0;
};

std::optional<double> given(double value) { return value > 0.0 ? std::optional(value) : std::nullopt; }

void run(const SheetArguments& arguments) {
  host::SheetValues values;
  values.name = arguments.name;
  values.kind = arguments.kind == "rotary" ? sim::DriveKind::rotary : sim::DriveKind::linear;
  values.by_current = arguments.effort == "current";
  values.motor_constant = given(arguments.constant);
  values.lead_mm_per_turn = given(arguments.lead);
  values.encoder_step_mm = given(arguments.step);
  values.sample_period_s = given(arguments.period_s);
  host::write_file_atomically(arguments.path, host::sheet_text(values));
  const std::string gaps = host::sheet_gaps(values);
  fmt::print("{} written{}\n", arguments.path, gaps.empty() ? "" : fmt::format("; fill in: {}", gaps));
}

}  // namespace

void add_sheet(CLI::App& app) {
  const auto arguments = std::make_shared<SheetArguments>();
  CLI::App* command = app.add_subcommand("sheet", "Write a commented data sheet of a drive to fill in");
  command->add_option("name", arguments->name, "name of the drive")
      ->required()
      ->check([](const std::string& name) -> std::string {
        return name.find_first_of("\"\\\n\r\t") == std::string::npos ? "" : "a name without quotes and backslashes";
      });
  command->add_option("--kind", arguments->kind, "rotary or linear")
      ->required()
      ->check(CLI::IsMember({"rotary", "linear"}));
  command->add_option("--effort", arguments->effort, "quantity in the logs: current (default) or voltage")
      ->check(CLI::IsMember({"current", "voltage"}));
  command->add_option("--kt", arguments->constant, "motor constant, Nm/A or N/A")->check(CLI::PositiveNumber);
  command->add_option("--lead", arguments->lead, "travel per motor turn, mm")->check(CLI::PositiveNumber);
  command->add_option("--step", arguments->step, "travel per encoder count, mm")->check(CLI::PositiveNumber);
  command->add_option("--period", arguments->period_s, "sampling period of the logs, s")->check(CLI::PositiveNumber);
  add_output(*command, "-o,--output", arguments->path, "the sheet to write (axis-model/1)")->required();
  const auto print_page = [] {
    fmt::print("{}", host::sheet_page());
    throw CLI::Success();
  };
  command->add_flag_callback("--markdown", print_page, "print the format's reference page instead")->trigger_on_parse();
  command->footer(
      "Examples:\n"
      "  axistool sheet z --kind rotary -o z-drive.toml\n"
      "  axistool sheet z --kind rotary --kt 0.71 --lead 10 --period 0.001 -o z-drive.toml");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
