// axistool bode: frequency response of an axis, measured now or from records, with margins and resonances.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/gate_arguments.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/json_output.hpp"
#include "host/axistool/motion_consent.hpp"
#include "host/evidence/presumed_sheet.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/record/read_record.hpp"
#include "host/response/model_starts.hpp"
#include "host/response/response_measurement.hpp"
#include "host/response/response_report.hpp"

namespace axistool {

namespace {

struct BodeArguments : DeviceArguments {
  std::vector<std::string> what, accepted;
  std::string model, parameters, box, report, folder, model_output;
  host::ResponsePlan plan;
  int countdown_s = 3;
  bool linear = false;
};

/// Model, controller and scales of the axis, as far as known.
struct Controlled {
  std::optional<sim::DriveDescription> model;
  std::optional<firmware::AxisParameters<float>> controller;
};

bool names_an_axis(const BodeArguments& arguments) {
  return arguments.what.size() == 1 &&
         std::ranges::find(firmware::kAxisNames, arguments.what.front()) != firmware::kAxisNames.end();
}

Controlled controlled_by_files(const BodeArguments& arguments) {
  Controlled found;
  if (!arguments.model.empty()) {
    found.model = host::read_model(arguments.model);
    found.controller = host::designed_parameters(*found.model, host::design_axis(*found.model, {}));
  }
  if (!arguments.parameters.empty()) {
    firmware::ParameterValues values;
    host::put_file(values, arguments.parameters, "x");
    found.controller = firmware::axis_parameters<float>(values.axis(0));
  }
  return found;
}

void keep_records(const std::vector<host::Record>& records, const std::string& folder) {
  if (folder.empty()) return;
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < records.size(); ++i)
    host::write_record(records[i], fmt::format("{}/run-{:02}.csv", folder, i + 1));
}

/// The runs on a board. Records before a failure are kept.
std::vector<host::Record> measure(const BodeArguments& arguments, Controlled& found) {
  if (arguments.box.empty())
    throw host::Failure(host::ExitCode::refused,
                        "nothing moves without a box: --box travel=…,speed=…,volts=…,time=…, which the board enforces");
  const bool is_linear = found.model ? found.model->data.kind == sim::DriveKind::linear : arguments.linear;
  const sim::DriveKind kind = is_linear ? sim::DriveKind::linear : sim::DriveKind::rotary;
  host::ResponsePlan plan = arguments.plan;
  plan.box = host::parse_box(arguments.box, kind);
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const std::string& name = arguments.what.front();
  const std::uint8_t axis = axis_index(name, board.axis_count());
  firmware::ParameterValues values = board.read_values();
  if (!arguments.parameters.empty()) host::put_file(values, arguments.parameters, name);
  if (!values.axis(axis).get<"drive.fitted">())
    throw host::Failure(host::ExitCode::refused,
                        fmt::format("axis {} has no controller yet: `axistool design MODEL -o PARAMS`, then `axistool "
                                    "set-params PARAMS`, or --params PARAMS here",
                                    name));
  const host::ExcitationScale scale = host::excitation_scale(values, axis, kind);
  found.controller = firmware::axis_parameters<float>(values.axis(axis));
  const std::vector<host::Excitation> runs = host::plan_response(plan, scale, *found.controller);
  if (talks(arguments)) {
    fmt::print("box: {}\n", box_text(plan.box, kind));
    if (arguments.dry_run)
      for (const host::Excitation& run : runs) fmt::print("{}\n", run.summary);
  }
  if (arguments.dry_run) return {};
  require_consent(arguments, fmt::format("Measure axis {}? It moves back and forth within this box: {}.", name,
                                         box_text(plan.box, kind)));
  catch_interrupts();
  count_down(arguments.countdown_s);
  if (!arguments.parameters.empty()) board.write_values(values);
  std::vector<host::Record> records;
  const auto progress = [&](std::size_t done, std::size_t of) {
    if (talks(arguments)) fmt::print(stderr, "run {} of {}\n", done, of);
  };
  try {
    host::measure_axis(board, axis, plan, values, scale, interrupted, records, progress);
  } catch (const host::Failure&) {
    keep_records(records, arguments.folder);
    throw;
  }
  keep_records(records, arguments.folder);
  return records;
}

/// The records, checked by the gate. Without a model, takes the drive from the first record.
std::vector<host::Record> admitted(const BodeArguments& arguments, const Controlled& found) {
  const sim::DriveDescription drive =
      found.model ? *found.model : host::presumed_sheet(host::read_record(arguments.what.front()));
  const host::Measurements measured = host::MeasurementGate(drive, {arguments.accepted}).read(arguments.what);
  if (talks(arguments)) print_log(measured.log());
  std::vector<host::Record> records;
  for (const host::Record* record : measured.training_records()) records.push_back(*record);
  return records;
}

void run(const BodeArguments& arguments) {
  Controlled found = controlled_by_files(arguments);
  const bool is_axis = names_an_axis(arguments);
  std::vector<host::Record> records;
  if (is_axis) {
    records = measure(arguments, found);
    if (arguments.dry_run) return;
  } else {
    records = admitted(arguments, found);
  }
  const host::AxisResponse axis = host::analyse_response(records, found.controller ? &*found.controller : nullptr);
  if (!arguments.json.empty()) write_json(host::response_json(axis), arguments.json);
  if (!arguments.report.empty())
    host::response_report(axis, is_axis ? "axis " + arguments.what.front() : fmt::format("{} records", records.size()))
        .write(arguments.report);
  std::vector<std::string> said;
  if (!arguments.model_output.empty()) {
    if (!found.model || !axis.fit)
      throw host::Failure(host::ExitCode::usage, "--model-output needs --model and a response with more frequencies");
    const host::ModelStarts starts = host::with_response(*found.model, *axis.fit, "axistool bode");
    host::write_model(starts.model, arguments.model_output);
    said = starts.said;
  }
  if (!talks(arguments)) return;
  fmt::print("{}", host::response_text(axis, host::terminal_of(stdout)));
  for (const std::string& line : said) fmt::print("{}: {}\n", arguments.model_output, line);
  if (!arguments.report.empty()) fmt::print("\nReport: {}\n", arguments.report);
}

}  // namespace

void add_bode(CLI::App& app) {
  auto arguments = std::make_shared<BodeArguments>();
  CLI::App* command = app.add_subcommand("bode", "Frequency response of an axis or of records: margins, resonances");
  add_input(*command, "AXIS|RECORD", arguments->what,
            "axis of a board to measure now (x, y, …), or records of one axis")
      ->required();
  add_input(*command, "--model", arguments->model,
            "model of the drive; with records, the controller that `design` makes from it");
  add_input(*command, "--params", arguments->parameters,
            "parameters of the axis; with records, the controller; on a board, set before measuring (not saved)");
  command->add_option("--box", arguments->box,
                      "travel=…,speed=…,volts=…,time=…: mm (linear: m), mm/s, V, s for all runs");
  command->add_option("--from", arguments->plan.from_Hz, "lowest frequency, Hz")->capture_default_str();
  command->add_option("--to", arguments->plan.to_Hz,
                      "highest frequency, Hz (default: a quarter of the control rate, at most 250)");
  command
      ->add_option("--realisations", arguments->plan.realisations,
                   "minimum number of runs in each band, each with different phases")
      ->capture_default_str()
      ->check(CLI::Range(2, 100));
  command->add_option("--seed", arguments->plan.seed, "seed of the random phases")->capture_default_str();
  command->add_flag("--linear", arguments->linear, "the drive is linear: use m and m/s");
  command->add_option("--countdown", arguments->countdown_s, "seconds before anything moves")
      ->capture_default_str()
      ->check(CLI::Range(0, 60));
  add_output(*command, "-o,--records", arguments->folder, "folder for the records of the runs",
             FileRole::output_folder);
  add_output(*command, "--model-output", arguments->model_output,
             "with --model: write the model with the compliance, delay or lag that the response shows, as starting "
             "values for a fit");
  add_output(*command, "--report", arguments->report, "write an HTML page with plots to this file");
  add_accept_option(*command, arguments->accepted);
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool bode x --box travel=60,speed=100,volts=4,time=120 --report bode.html\n"
      "  axistool bode run-*.csv --model x.toml --json -        # records, with the controller that design makes\n"
      "The axis jogs slowly back and forth, so that friction keeps its sign, and a sum of sines is added to the\n"
      "controller's output. Runs with different phases separate noise from nonlinearity. Records of `excite …\n"
      "multisine` are analysed the same way, all others by Welch's method. With a controller: open loop, sensitivity,\n"
      "gain, phase and modulus margin with 95 % intervals. A wider travel allows a\n"
      "faster jog, which reduces the influence of friction.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
