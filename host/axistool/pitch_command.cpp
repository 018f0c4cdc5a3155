// axistool pitch: measured pitch errors of an axis's screw, which the board subtracts from its reference.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "host/atomic_file.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/pitch_table.hpp"
#include "host/read_file.hpp"

namespace axistool {

namespace {

struct PitchArguments : DeviceArguments {
  std::string file, axis, output;
  bool off = false, remove = false;
};

void pitch(const PitchArguments& arguments) {
  if (arguments.remove && !arguments.file.empty())
    throw host::Failure(host::ExitCode::usage, "FILE and --remove contradict each other: give one of them");
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const firmware::ParameterValues values = board.read_values();
  const auto axis = static_cast<std::uint8_t>(axis_index(arguments.axis, values.axes()));
  if (!values.axis(axis).get<"drive.fitted">())
    throw host::Failure(host::ExitCode::refused,
                        fmt::format("axis {} is not fitted: set the parameters of a design first", arguments.axis));
  const double count_mm = host::count_mm_of(values, axis);
  const bool changes = arguments.remove || !arguments.file.empty();
  host::PitchPoints points;
  bool on = false;
  if (changes) {
    if (!arguments.remove) points = host::parse_pitch(host::read_file(arguments.file), arguments.file, count_mm);
    on = !points.empty() && !arguments.off;
    if (!arguments.dry_run) host::write_pitch(board, axis, points, on);
  } else {
    points = host::read_pitch(board, axis);
    on = values.axis(axis).get<"pitch.on">();
  }
  if (!arguments.output.empty()) host::write_file_atomically(arguments.output, host::format_pitch(points, count_mm));
  if (!arguments.json.empty()) {
    nlohmann::json rows = nlohmann::json::array();
    const double um = 1e3 * count_mm / 65536.0;
    for (const firmware::PitchPoint& one : points)
      rows.push_back(
          {{"x_mm", one.counts * count_mm}, {"forward_um", one.forward * um}, {"backward_um", one.backward * um}});
    write_json({{"format", "axis-pitch/1"},
                {"axis", arguments.axis},
                {"on", on},
                {"saved", changes && !arguments.dry_run},
                {"points", rows}},
               arguments.json);
  }
  if (!talks(arguments)) return;
  const std::string text = points.empty() ? "none" : host::pitch_text(points, on, count_mm);
  fmt::print("axis {}: table of pitch errors {}: {}{}\n", arguments.axis,
             !changes            ? "now"
             : arguments.dry_run ? "would be"
                                 : "saved with the parameters",
             text, on ? "; acts once the axis is homed" : "");
  if (!changes && arguments.output.empty())
    fmt::print("{}", points.empty() ? "" : host::format_pitch(points, count_mm));
}

}  // namespace

void add_pitch(CLI::App& app) {
  auto arguments = std::make_shared<PitchArguments>();
  CLI::App* command = app.add_subcommand("pitch", "Load or show an axis's measured pitch errors");
  add_input(*command, "FILE", arguments->file,
            "CSV, one row per position, up to 256: x_mm,forward_um,backward_um (or x_mm,error_um), actual minus "
            "commanded position for each direction of approach; without it, show the board's table");
  command->add_option("--axis", arguments->axis, "x, y, z or a")->required();
  command->add_flag("--off", arguments->off, "load it, but leave pitch.on off");
  command->add_flag("--remove", arguments->remove, "remove the axis's table from the board");
  add_output(*command, "-o,--output", arguments->output, "write the table to this file, in the format of FILE");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool pitch screw.csv --axis x\n"
      "  axistool pitch --axis x -o now.csv\n"
      "Measure with the axis homed, its pitch.on off and all other compensation as in use. The error is interpolated "
      "linearly between rows and constant beyond them. Saves the table together with all present parameters of the "
      "board. Refused (exit code 8) while a drive is enabled. Exit code 9: the file is bad.");
  command->callback([arguments] { pitch(*arguments); });
}

}  // namespace axistool
