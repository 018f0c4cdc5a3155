// axistool excite: an experiment on an axis, within a box that the board enforces -> record.
#include <fmt/format.h>

#include <memory>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/excitation/excitation_run.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/json_output.hpp"
#include "host/axistool/motion_consent.hpp"
#include "host/axistool/parameter_commands.hpp"
#include "host/device/excitation.hpp"
#include "host/device/excitation_end.hpp"
#include "host/device/motion.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/data_sheet_values.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/plan/run_plan.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct ExciteArguments : DeviceArguments {
  std::string axis, kind, box, output, drive, closed_loop, parameters;
  std::vector<std::string> numbers;
  unsigned seed = 1;
  int countdown_s = 3;
  bool linear = false, as_set = false;
};

/// The board's parameters, with the values of the data sheet if one is given.
firmware::ParameterValues scaled_values(const ExciteArguments& arguments, host::BoardClient& board, std::uint8_t axis,
                                        std::optional<sim::DriveDescription>& drive) {
  firmware::ParameterValues values = board.read_values();
  if (!arguments.parameters.empty()) {
    values = with_changes(values, {arguments.parameters}, arguments.axis);
    host::require_fitting_set(values);
    if (!arguments.dry_run) board.write_values(values);
  }
  if (!arguments.drive.empty()) {
    drive = host::read_drive(arguments.drive);
    return host::with_data_sheet(values, axis, drive->data);
  }
  if (!values.axis(axis).get<"drive.fitted">() && !arguments.as_set && host::has_initial_scales(values, axis))
    throw host::Failure(
        host::ExitCode::refused,
        fmt::format(
            "axis {} has its initial parameters, so counts and volts have no known scale. Give the data sheet "
            "with --drive DRIVE.toml, or set {}.drive.encoder_resolution and the other scales, or give --as-set "
            "if the initial values are right",
            arguments.axis, arguments.axis));
  return values;
}

host::ExcitationScale scale_of(const ExciteArguments& arguments, const firmware::ParameterValues& values,
                               std::uint8_t axis, const std::optional<sim::DriveDescription>& drive) {
  host::ExcitationScale scale = host::excitation_scale(values, axis,
                                                       drive              ? drive->data.kind
                                                       : arguments.linear ? sim::DriveKind::linear
                                                                          : sim::DriveKind::rotary);
  if (drive) scale.lead = static_cast<double>(values.axis(axis).get<"drive.lead">());
  if (drive) scale.table_resolution = drive->data.load_encoder_resolution;
  return scale;
}

nlohmann::json document_of(const ExciteArguments& arguments, const host::ExcitationOutcome& outcome,
                           const host::ExcitationScale& scale, std::size_t rows) {
  return {{"format", "axis-excitation/1"},
          {"axis", arguments.axis},
          {"kind", arguments.kind},
          {"file", arguments.output},
          {"ended", host::end_name(outcome.state)},
          {"duration_s", outcome.state.elapsed / scale.rate_Hz},
          {"farthest", outcome.state.farthest * scale.encoder_resolution},
          {"fastest", static_cast<double>(outcome.state.fastest) * scale.encoder_resolution * scale.rate_Hz},
          {"rows", rows},
          {"lost_rows", outcome.capture.lost},
          {"dropped_by_board", outcome.capture.dropped_by_board}};
}

/// The excitations to run: a single one, or the pieces of a planned run.
struct Programme {
  host::RunPlan run;
  bool is_plan = false;

  Programme(const ExciteArguments& arguments, sim::DriveKind kind) : is_plan(arguments.kind.ends_with(".toml")) {
    if (is_plan) run = host::read_run_plan(arguments.kind);
    if (is_plan && !(arguments.numbers.empty() && arguments.closed_loop.empty()))
      throw host::Failure(host::ExitCode::usage, "a planned run contains its own values; edit its file");
    if (arguments.box.empty() && !is_plan)
      throw host::Failure(
          host::ExitCode::refused,
          "nothing moves without a box: --box travel=…,speed=…,volts=…,time=…, which the board enforces");
    if (!arguments.box.empty()) {
      const host::ExcitationLimits asked = host::parse_box(arguments.box, kind);
      run.box = is_plan ? host::within_both(run.box, asked) : asked;
    }
    if (!is_plan)
      run.pieces = {{arguments.kind, host::parse_numbers(arguments.numbers), arguments.closed_loop, run.box.time_s,
                     arguments.seed}};
  }
};

void run(const ExciteArguments& arguments) {
  std::optional<sim::DriveDescription> drive;
  if (!arguments.drive.empty()) drive = host::read_drive(arguments.drive);
  const bool is_linear = drive ? drive->data.kind == sim::DriveKind::linear : arguments.linear;
  const Programme programme(arguments, is_linear ? sim::DriveKind::linear : sim::DriveKind::rotary);
  const host::RunPlan& plan = programme.run;
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const std::uint8_t axis = axis_index(arguments.axis, board.axis_count());
  const firmware::ParameterValues values = scaled_values(arguments, board, axis, drive);
  const host::ExcitationScale scale = scale_of(arguments, values, axis, drive);
  std::map<std::string, std::string> header;
  for (const host::RunPiece& piece : plan.pieces) {
    const host::Excitation excitation = host::design_piece(piece, plan.box, 0.0, scale);
    header = excitation.header;
    if (talks(arguments)) fmt::print("{}\n", excitation.summary);
  }
  if (talks(arguments)) fmt::print("box: {}\n", box_text(plan.box, scale.kind));
  if (arguments.dry_run) return;
  require_consent(arguments, fmt::format("Excite axis {}? It moves within this box: {}.", arguments.axis,
                                         box_text(plan.box, scale.kind)));
  catch_interrupts();
  count_down(arguments.countdown_s);
  const host::ExcitationOutcome outcome = host::run_excitations(
      board, axis, plan.pieces.size(),
      [&](std::size_t piece, double offset) { return host::design_piece(plan.pieces[piece], plan.box, offset, scale); },
      values, scale, interrupted);
  host::Record record = host::capture_record(outcome.capture, outcome.settings, arguments.axis);
  record.header["source"] = "axistool excite";
  if (programme.is_plan) header = host::run_header(plan);
  record.header.insert(header.begin(), header.end());
  record.header["excitation_ended"] = std::string(host::end_name(outcome.state));
  host::write_record(record, arguments.output);
  if (!arguments.json.empty()) write_json(document_of(arguments, outcome, scale, record.size()), arguments.json);
  if (talks(arguments))
    fmt::print("{}: {} rows in {}, {} lost\n", host::end_name(outcome.state), record.size(), arguments.output,
               outcome.capture.lost);
  host::require_completed(board, axis, outcome, arguments.output + " holds the rows so far");
}

std::string kinds_footer() {
  std::string text =
      "Examples:\n"
      "  axistool excite x steps --box travel=40,speed=150,volts=3,time=5 --drive x.toml -o steps.csv\n"
      "  axistool excite x multisine amplitude=0.5 from=5 to=200 --closed-loop output --box … -o lines.csv\n"
      "  axistool excite x ladder 5 20 80 --box travel=100,speed=120,volts=5,time=20 -o ladder.csv\n"
      "  axistool excite x run.toml -o run.csv       # what `axistool plan` wrote; all pieces in one record\n"
      "KIND and its values, all optional:\n";
  for (const host::ExcitationKindText& kind : host::kExcitationKindTexts)
    text += fmt::format("  {:<10} {}: {}\n", kind.name, kind.does, kind.numbers);
  return text +
         "Steps and ramps need no controller, so they give the first record of a drive. travel is the width of a "
         "window centred on the present position. If the axis leaves the box, it stops; the exit code is 8 and the "
         "record is kept.";
}

}  // namespace

void add_excite(CLI::App& app) {
  auto arguments = std::make_shared<ExciteArguments>();
  CLI::App* command = app.add_subcommand("excite", "Move an axis by an experiment, within a box -> record");
  command->add_option("AXIS", arguments->axis, "x, y, …")->required();
  add_input(*command, "KIND", arguments->kind,
            "steps, ramp, sine, chirp, multisine, reversals, ladder, dwell; or a RUN.toml that plan wrote")
      ->required();
  command->add_option("NUMBERS", arguments->numbers, "values of the kind, in order or as name=value");
  command->add_option("--box", arguments->box,
                      "travel=…,speed=…,volts=…,time=…: mm (linear: m), mm/s, V, s; a planned run has its own");
  add_output(*command, "-o,--output", arguments->output, "record to write (axis-record/1)")->required();
  add_input(*command, "--drive", arguments->drive, "data sheet of the drive: units of counts, volts and travel");
  add_input(*command, "--params", arguments->parameters, "parameters to set first (axis-params/1), not saved");
  command->add_flag("--as-set", arguments->as_set, "for an axis without a design: use the scales on the board");
  command->add_flag("--linear", arguments->linear, "the drive is linear: m and m/s");
  command->add_option("--closed-loop", arguments->closed_loop,
                      "where to add the excitation: 'reference', or the controller's 'output'");
  command->add_option("--seed", arguments->seed, "seed of a multisine's phases")->capture_default_str();
  command->add_option("--countdown", arguments->countdown_s, "seconds before anything moves")
      ->capture_default_str()
      ->check(CLI::Range(0, 60));
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(kinds_footer());
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
