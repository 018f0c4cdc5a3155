// axistool get-params, set-params, diff-params, reset-params: parameters of a board that is running.
#include "host/axistool/parameter_commands.hpp"

#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/parameters/parameter_names.hpp"

namespace axistool {

namespace {

using firmware::ParameterValues;

struct ParameterArguments : DeviceArguments {
  std::vector<std::string> names, sources;
  std::string output, axis;
  bool save = false, defaults = false;
};

void get_params(const ParameterArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const ParameterValues values = board.read_values();
  std::vector<std::size_t> places;
  for (const std::string& name : arguments.names) {
    const std::size_t before = places.size();
    for (std::size_t place = 0; place < values.size(); ++place) {
      const std::string full = host::full_name(place);
      if (full == name || full.starts_with(name + ".")) places.push_back(place);
    }
    if (places.size() == before)
      throw host::Failure(host::ExitCode::bad_input, host::place_named(name)
                                                         ? fmt::format("{}: the board has no such axis", name)
                                                         : fmt::format("no parameter of the board is called {}{}; "
                                                                       "`axistool get-params` lists them",
                                                                       name, host::parameter_hint(name)));
  }
  if (arguments.names.empty())
    for (std::size_t place = 0; place < values.size(); ++place) places.push_back(place);

  if (!arguments.json.empty()) {
    nlohmann::json list = nlohmann::json::object();
    for (const std::size_t place : places) list[host::full_name(place)] = value_json(place, values.at(place));
    write_json({{"format", "axis-board-params/1"}, {"schema_hash", firmware::kSchemaHash}, {"parameters", list}},
               arguments.json);
  }
  if (!talks(arguments)) return;
  for (const std::size_t place : places) {
    const firmware::ParameterInfo& info = host::info_at(place);
    fmt::print("{:<32} {:>14} {}\n", host::full_name(place), host::value_text(info, values.at(place)),
               info.unit == "1" ? "" : host::unit_text(info));
  }
}

/// Sets the parameters on the board; in a dry run, only prints the changes.
void change(host::BoardClient& board, const DeviceArguments& arguments, const ParameterValues& before,
            const ParameterValues& after, bool save) {
  host::require_fitting_set(after);
  const std::vector<Difference> changes = differences(before, after);
  if (!arguments.dry_run) {
    board.write_values(after);
    if (save) board.save();
  }
  if (!arguments.json.empty())
    write_json({{"format", "axis-params-change/1"},
                {"changes", differences_json(changes)},
                {"applied", !arguments.dry_run},
                {"saved", save && !arguments.dry_run}},
               arguments.json);
  if (!talks(arguments)) return;
  print_differences(changes, "was", "is");
  if (arguments.dry_run)
    fmt::print("{} parameters would change; nothing was done\n", changes.size());
  else
    fmt::print("{} parameters changed, read back and verified; {}\n", changes.size(),
               save ? "saved" : "not saved: `axistool save` keeps them after power-off");
}

void set_params(const ParameterArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const ParameterValues before = board.read_values();
  change(board, arguments, before, with_changes(before, arguments.sources, arguments.axis), arguments.save);
}

void reset_params(const ParameterArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const ParameterValues before = board.read_values();
  if (!arguments.dry_run)
    require_consent(arguments,
                    "Set all parameters of the board to their initial values? Afterwards no axis is fitted.");
  change(board, arguments, before, ParameterValues(before.axes()), arguments.save);
}

void diff_params(const ParameterArguments& arguments) {
  if (arguments.defaults == !arguments.sources.empty())
    throw host::Failure(host::ExitCode::usage, "diff-params needs either a FILE or --defaults");
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const ParameterValues values = board.read_values();
  const ParameterValues other =
      arguments.defaults ? ParameterValues(values.axes()) : with_changes(values, arguments.sources, arguments.axis);
  const std::vector<Difference> list = differences(other, values);
  if (!list.empty()) end_with(host::ExitCode::answer_is_no);
  if (!arguments.json.empty())
    write_json({{"format", "axis-params-diff/1"}, {"differences", differences_json(list)}}, arguments.json);
  if (!talks(arguments)) return;
  print_differences(list, arguments.defaults ? "initially" : "file", "board");
  fmt::print("{}\n", list.empty() ? "no difference" : fmt::format("{} parameters differ", list.size()));
}

}  // namespace

ParameterValues with_changes(ParameterValues values, const std::vector<std::string>& sources, const std::string& axis) {
  if (!axis.empty()) axis_index(axis, values.axes());
  for (const std::string& source : sources) {
    if (source.find('=') != std::string::npos && !source.ends_with(".toml")) {
      host::put(values, host::parse_assignment(source));
    } else {
      host::put_file(values, source, axis);
    }
  }
  return values;
}

void print_differences(const std::vector<Difference>& list, const char* before, const char* after) {
  if (list.empty()) return;
  fmt::print("{:<32} {:>14} {:>14}\n", "", before, after);
  for (const Difference& one : list) {
    const firmware::ParameterInfo& info = host::info_at(one.place);
    fmt::print("{:<32} {:>14} {:>14} {}\n", host::full_name(one.place), host::value_text(info, one.before),
               host::value_text(info, one.after), info.unit == "1" ? "" : host::unit_text(info));
  }
}

nlohmann::json value_json(std::size_t place, float value) {
  if (host::info_at(place).type == firmware::ParameterType::toggle) return value != 0.0F;
  return value;
}

nlohmann::json differences_json(const std::vector<Difference>& list) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Difference& one : list)
    rows.push_back({{"name", host::full_name(one.place)},
                    {"before", value_json(one.place, one.before)},
                    {"after", value_json(one.place, one.after)}});
  return rows;
}

void add_get_params(CLI::App& app) {
  auto arguments = std::make_shared<ParameterArguments>();
  CLI::App* command = app.add_subcommand("get-params", "Print the values of a board's parameters");
  command->add_option("NAME", arguments->names, "parameters or groups: x.kalman.k11, x.kalman, x; default: all");
  add_device_options(*command, *arguments);
  command->footer("Examples:\n  axistool get-params x.kalman\n  axistool get-params --sim --json -");
  command->callback([arguments] { get_params(*arguments); });
}

void add_set_params(CLI::App& app) {
  auto arguments = std::make_shared<ParameterArguments>();
  CLI::App* command =
      app.add_subcommand("set-params", "Set parameters of a board: all of them, or none if one is wrong");
  add_input(*command, "FILE|NAME=VALUE", arguments->sources, "files (axis-params/1) and single values, in this order")
      ->required();
  command->add_option("--axis", arguments->axis, "board axis that gets a file's single axis: x, y …");
  command->add_flag("--save", arguments->save, "also save them, as `axistool save` does");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool set-params x-params.toml --save\n"
      "  axistool set-params x.feedback.k1=48.4 x.feedback.k2=0.61 --dry-run\n"
      "  axistool set-params stage-params.toml --axis y --device usb:A1B2C3\n"
      "Drives must be disabled. `axistool parameters` lists names, ranges and units.");
  command->callback([arguments] { set_params(*arguments); });
}

void add_diff_params(CLI::App& app) {
  auto arguments = std::make_shared<ParameterArguments>();
  CLI::App* command =
      app.add_subcommand("diff-params", "List where a board's parameters differ from a file, bit by bit");
  add_input(*command, "FILE", arguments->sources, "file of parameters; only the parameters in it are compared");
  command->add_flag("--defaults", arguments->defaults, "compare with the initial values");
  command->add_option("--axis", arguments->axis, "board axis to compare with the file's single axis: x, y …");
  add_device_options(*command, *arguments);
  command->footer("Example:\n  axistool diff-params x-params.toml\nExit code 1: there are differences.");
  command->callback([arguments] { diff_params(*arguments); });
}

void add_reset_params(CLI::App& app) {
  auto arguments = std::make_shared<ParameterArguments>();
  CLI::App* command = app.add_subcommand("reset-params", "Set all parameters of a board to their initial values");
  command->add_flag("--save", arguments->save, "save them too");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer("Example:\n  axistool backup before.toml && axistool reset-params --save --yes");
  command->callback([arguments] { reset_params(*arguments); });
}

}  // namespace axistool
