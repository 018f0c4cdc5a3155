// axistool run: a G-code program on a board.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "host/axes/path_command.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/axistool/program_run.hpp"
#include "host/device/closed_loops.hpp"
#include "host/device/motion.hpp"
#include "host/identify/linear_axis.hpp"
#include "host/known_by_current.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/path/path_extents.hpp"
#include "host/read_file.hpp"

namespace axistool {

namespace {

using firmware::PathEnd;
using host::ExitCode;
using host::Failure;

host::PathPoint standing(const host::BoardState& status, const host::PathScale& scale) {
  std::vector<host::BoardPosition> at;
  for (const std::size_t axis : scale.axes) at.push_back({status.axis.at(axis).counts(), 0.0});
  return point_of(at, scale);
}

/// Plans the program as if the probe never made contact.
Planned plan(const std::string& text, const RunArguments& arguments, const host::PathBoard& board,
             const host::PathPoint& start) {
  Planned planned{read_program(text, arguments, board, start, {}), {}};
  planned.path = plan_moves(planned.program.moves, arguments, board);
  if (planned.path.knots.size() < 2)
    throw Failure(ExitCode::bad_input, fmt::format("{}: the program contains no motion", arguments.file));
  return planned;
}

std::string box_text(const host::PathExtents& extents, std::size_t axes) {
  std::string text;
  for (std::size_t i = 0; i < axes; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    text += fmt::format("{}{} {:.3f} to {:.3f} mm", i > 0 ? ", " : "", firmware::kAxisNames.at(i), extents.least[k],
                        extents.most[k]);
  }
  return text;
}

nlohmann::json document_of(const RunArguments& arguments, const Planned& planned, std::size_t axes) {
  const host::PathExtents extents = host::extents_of(planned.path);
  nlohmann::json document = {{"format", "axis-run/1"},
                             {"file", arguments.file},
                             {"lines", planned.program.lines},
                             {"duration_s", planned.path.duration_s()},
                             {"probes", nlohmann::json::array()},
                             {"nodes", planned.path.knots.size() - 1},
                             {"contour_um", nullptr},
                             {"contour_rms_um", nullptr}};
  for (std::size_t i = 0; i < axes; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    document["extents_mm"][std::string(firmware::kAxisNames.at(i))] = {extents.least[k], extents.most[k]};
  }
  return document;
}

using Drives = std::vector<std::optional<sim::DriveDescription>>;

/// The drive of each axis: from its model, else from the parameters.
Drives drives_of(const RunArguments& arguments, const firmware::ParameterValues& values, std::size_t axes) {
  if (arguments.models.size() > axes)
    throw Failure(ExitCode::usage, fmt::format("--model: {} models for {} axes; give them in the order of the axes",
                                               arguments.models.size(), axes));
  if (!arguments.capture.empty() && arguments.models.size() > host::most_path_forces(axes))
    throw Failure(ExitCode::usage,
                  fmt::format("a record of {} axes has room for {} process forces: give --capture with "
                              "fewer models",
                              axes, host::most_path_forces(axes)));
  Drives drives;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (axis >= arguments.models.size()) {
      drives.push_back(host::drive_of_parameters(values.axis(axis), firmware::kAxisNames.at(axis)));
      continue;
    }
    drives.push_back(host::read_model(arguments.models[axis]));
    host::require_volts(drives.back()->data, drives.back()->name, "a board");
    host::rigid_axis(*drives.back());
  }
  return drives;
}

void say_commands(const std::vector<host::CommandNeed>& needs, const Drives& drives) {
  for (const host::CommandNeed& need : needs)
    fmt::print(
        "{} needs at most {:.2f} V of {:.2f} V ({:.0f} %): line {}, {:.3f} s, at {:.3f} mm with {:.4g} mm/s and "
        "{:.4g} mm/s^2\n",
        need.axis, need.command_V, need.limit_V, 100.0 * need.share(), need.line, need.time_s, need.position_mm,
        need.speed_mm_s, need.acceleration_mm_s2);
  for (std::size_t axis = 0; axis < drives.size(); ++axis)
    if (!drives[axis])
      fmt::print(
          "the command that {} needs is unknown: the parameters contain no model of it (`axistool design` writes "
          "one); --model gives one\n",
          firmware::kAxisNames.at(axis));
}

/// Throws if an axis cannot follow.
void require_command(const std::vector<host::CommandNeed>& needs, const RunArguments& arguments) {
  const auto most = std::ranges::max_element(needs, {}, &host::CommandNeed::share);
  if (most == needs.end() || most->share() <= 1.0) return;
  throw Failure(ExitCode::answer_is_no,
                fmt::format("{}:{}: {} needs {:.3g} V, but no more than {:.3g} V has an effect at {:.4g} mm/s. Lower "
                            "{}.limits.acceleration and {}.limits.velocity (`axistool design` finds them), or the feed",
                            arguments.file, most->line, most->axis, most->command_V, most->limit_V, most->speed_mm_s,
                            most->axis, most->axis));
}

bool has_terminal() { return ::isatty(STDIN_FILENO) != 0; }

/// Throws if the program waits for an operator but there is no terminal.
void require_operator(const RunArguments& arguments, const host::PlannedPath& path) {
  if (path.stops.empty() || arguments.passes_stops || has_terminal()) return;
  throw Failure(ExitCode::refused,
                fmt::format("{} waits for the operator in line {} (M0, M1), but this is no terminal: run it on a "
                            "terminal, or with --pass-stops, which skips the stops",
                            arguments.file, path.stops.front().line));
}

void say_end(host::BoardClient& board, const host::PathBoard& axes, PathEnd end) {
  if (end == PathEnd::fault || end == PathEnd::host_lost)
    for (const std::size_t axis : axes.scale.axes)
      host::require_no_fault(board.status(), static_cast<std::uint8_t>(axis));
  if (end == PathEnd::starved)
    throw Failure(ExitCode::time_out,
                  "the program arrived too slowly, so the board stopped on the path: is this computer busy?");
  if (end == PathEnd::touched)
    throw Failure(ExitCode::answer_is_no,
                  "the probe made contact while the program did not probe; the axes stand on the path");
  if (end != PathEnd::completed)
    throw Failure(ExitCode::answer_is_no, fmt::format("{} before its end; the axes stand on the path", end_name(end)));
}

/// Prints the outcome and adds it to the JSON `document`.
void tell(const ProgramOutcome& outcome, const RunArguments& arguments, nlohmann::json& document) {
  document["duration_s"] = outcome.path_s;
  document["clock_s"] = outcome.clock_s;
  document["planned_s"] = outcome.planned_s;
  document["contour_um"] = outcome.worst_um;
  document["contour_rms_um"] =
      std::sqrt(outcome.squares_um2 / static_cast<double>(std::max<std::size_t>(1, outcome.rows)));
  const std::string why(outcome.failure.empty() ? end_name(outcome.end) : "probe");
  document["stopped_because"] = why;
  document["lost_rows"] = outcome.lost_rows;
  for (const ProbeResult& result : outcome.probes) {
    const bool found = !result.mm.empty();
    nlohmann::json one = {
        {"line", result.line}, {"word", word_of(result.probe)}, {"found", found}, {"position_mm", nullptr}};
    std::string where;
    for (std::size_t i = 0; i < result.mm.size(); ++i) {
      one["position_mm"][std::string(firmware::kAxisNames.at(i))] = result.mm[i];
      where += fmt::format("{} {} {:.4f} mm", i > 0 ? "," : " at", firmware::kAxisNames.at(i), result.mm[i]);
    }
    document["probes"].push_back(one);
    if (talks(arguments))
      fmt::print("line {}: {}{}{}\n", result.line, found ? "" : "no ", sought_by(result.probe), where);
  }
  if (!talks(arguments)) return;
  fmt::print("{}: {:.2f} s{}, contour error {:.1f} um at most\n", why, outcome.path_s,
             outcome.clock_s > outcome.path_s + 0.1 ? fmt::format(" of motion in {:.2f} s", outcome.clock_s) : "",
             outcome.worst_um);
}

/// Throws if the program probes but the board has no probe.
void require_probe(host::BoardClient& board, const RunArguments& arguments, const host::GcodeProgram& program) {
  if (program.probes.empty() || (board.probe_state().flags & firmware::kProbeWired) != 0) return;
  throw Failure(ExitCode::refused,
                fmt::format("{} probes in line {}, but no probe is wired: set probe.input to 1 (its input closes on "
                            "contact) or 2 (it opens)",
                            arguments.file, program.moves[program.probes.front().move].line));
}

/// Checks the program without a machine.
void require_program(const std::string& text, const RunArguments& arguments) {
  host::GcodeMachine any;
  any.axes = 3;
  any.begins_anywhere = true;
  host::read_gcode(text, arguments.file, host::PathPoint::Zero(), any);
}

/// Empty for a dry run without a board; the limits then come from files or are a new board's initial ones.
std::optional<host::BoardClient> board_of(const RunArguments& arguments) {
  if (arguments.dry_run && !arguments.params.empty()) return {};
  try {
    return open_board(arguments);
  } catch (const Failure& failure) {
    if (!arguments.dry_run || !arguments.device.empty() || failure.code != ExitCode::no_such_device) throw;
    return {};
  }
}

firmware::ParameterValues values_without_board(const RunArguments& arguments) {
  firmware::ParameterValues values{hal::kAxisCount};
  for (const std::string& file : arguments.params) host::put_file(values, file);
  if (talks(arguments))
    fmt::print("no board contacted: {}\n", arguments.params.empty()
                                               ? "checked against a new board's limits; --params FILE gives others"
                                               : "checked against the limits of the files");
  return values;
}

void run(const RunArguments& arguments) {
  const std::string text = host::read_file(arguments.file, host::kProgramSize);
  require_program(text, arguments);
  std::optional<host::BoardClient> asked = board_of(arguments);
  if (asked) asked->require_same_table();
  const firmware::ParameterValues values = asked ? asked->read_values() : values_without_board(arguments);
  const std::size_t axes = std::min<std::size_t>(asked ? asked->axis_count() : hal::kAxisCount, 3);
  const unsigned metres = arguments.linear.empty() ? 0u : axis_mask(arguments.linear, axes);
  const host::PathBoard machine = host::path_board(values, axes, metres, !arguments.dry_run);
  const auto mask = static_cast<std::uint8_t>((1u << axes) - 1u);

  const Planned planned =
      plan(text, arguments, machine, asked ? standing(asked->status(), machine.scale) : host::PathPoint::Zero());
  nlohmann::json document = document_of(arguments, planned, axes);
  const host::PathExtents extents = host::extents_of(planned.path);
  if (talks(arguments))
    fmt::print("{}: {} lines, {:.2f} s, {}\n", arguments.file, planned.program.lines, planned.path.duration_s(),
               box_text(extents, axes));
  const Drives drives = drives_of(arguments, values, axes);
  const std::vector<host::CommandNeed> needs = host::largest_commands(planned.path, machine.scale, drives);
  document["commands"] = host::commands_json(needs);
  if (talks(arguments)) say_commands(needs, drives);
  if (arguments.dry_run) {
    document["stopped_because"] = "dry run";
    if (!arguments.json.empty()) write_json(document, arguments.json);
    require_command(needs, arguments);
    return;
  }
  host::BoardClient& board = *asked;
  const bool relative = arguments.here || !planned.program.is_absolute;
  require_startable(board, machine.scale, relative);
  require_probe(board, arguments, planned.program);
  require_operator(arguments, planned.path);
  require_consent(arguments, fmt::format("Run {}? The axes move within {}.", arguments.file, box_text(extents, axes)));
  catch_signals();
  host::ClosedLoops loops(board, mask);
  // Begins at the present references, because the loops are closed now.
  const ProgramOutcome outcome = run_program(board, machine, relative, arguments, text);
  loops.open();
  tell(outcome, arguments, document);
  if (!arguments.json.empty()) write_json(document, arguments.json);
  if (!outcome.failure.empty()) throw Failure(ExitCode::answer_is_no, outcome.failure);
  say_end(board, machine, outcome.end);
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a G-code program on the board's axes");
  add_input(*command, "FILE", arguments->file, "program (RS274/NGC)")->required();
  add_output(*command, "--capture", arguments->capture,
             "record to write (axis-record/1), with the contour error, and with --model the "
             "process forces");
  command->add_option("--feed", arguments->feed_percent, "override of the feeds F, %; limits of the axes hold")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 120.0));
  command->add_option("--rapid", arguments->rapid_percent, "override of rapids (G0, G28), %")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 100.0));
  command->add_option("--linear", arguments->linear, "axes whose parameters are in metres")->delimiter(',');
  command->add_flag("--here", arguments->here, "for axes that are not homed: take their counts as positions");
  command->add_flag("--pass-stops", arguments->passes_stops, "skip the stops M0 and M1; watch the program");
  add_input(*command, "--params", arguments->params, "with --dry-run: take limits from these files, without a board");
  add_input(*command, "--model", arguments->models,
            "models of the axes in their order (axis-model/1): they add weight and the amplifier's limits, which the "
            "board's parameters lack; --capture then also records the process force of each on the table, "
            "process_force_N (y_process_force_N), as capture --model does, in rows at 500 Hz at most");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool run part.ngc --dry-run              # time, extents, largest commands\n"
      "  axistool run part.ngc --dry-run --model x.toml y.toml\n"
      "  axistool run part.ngc --capture part.csv\n"
      "  axistool run part.ngc --feed 120 --rapid 25\n"
      "A dry run prints the largest command that each axis needs, and where. Exit code 1: an axis cannot follow.\n"
      "Known: G0 G1 G2 G3 (I J, or R) G4 P G17 G20 G21 G28 G38.2 to G38.5 G54 G61 G64 P G90 G91, F, M0 M1 M2 M30,\n"
      "X Y Z, N, comments; anything else is an error that names the line. The path is exact (G61) unless the program "
      "says G64; G64\n"
      "without P has a tolerance of 0.05 mm. On a terminal Ctrl-Z holds and resumes the feed, Ctrl-C stops on the "
      "path,\n"
      "M0 and M1 wait for Enter, there or in the workbench. - and + override the feeds while it runs, and < and > the\n"
      "rapids: in steps of 10 %, up to what was planned (--feed, --rapid).");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
