// axistool enable, disable, jog, home, move: moves a board's axes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/board_report.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/parameter_names.hpp"

namespace axistool {

namespace {

struct MotionArguments : DeviceArguments {
  std::vector<std::string> axes;
  std::string axis;
  double value = 0.0, duration_s = 1.0;
  bool relative = false, take_over = false, here = false;
  std::string mode;
  double speed = 0.0;
};

/// Names, indexed by homing.mode.
constexpr std::array<const char*, 4> kHomingModes{"none", "switch", "index", "both"};

double position_of(host::BoardClient& board, std::uint8_t axis, const firmware::ParameterValues& values) {
  const double resolution = static_cast<double>(values.axis(axis).get<"drive.encoder_resolution">());
  return static_cast<double>(board.status().axis.at(axis).counts()) * resolution;
}

void report(const MotionArguments& arguments, const char* what, nlohmann::json document) {
  document["format"] = "axis-motion/1";
  document["command"] = what;
  document["done"] = !arguments.dry_run;
  if (!arguments.json.empty()) write_json(document, arguments.json);
}

void enable(const MotionArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const std::uint8_t mask = axis_mask(arguments.axes, board.axis_count());
  if (!arguments.dry_run) {
    require_consent(arguments, "Close the control loop? The axis may move.");
    if (arguments.take_over) board.take_over();
    host::enable_and_wait(board, mask);
  }
  report(arguments, "enable", {{"axes", arguments.axes}});
  if (talks(arguments)) fmt::print("{}\n", arguments.dry_run ? "would enable" : "enabled");
}

void disable(const MotionArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const std::uint8_t mask = axis_mask(arguments.axes, board.axis_count());
  if (!arguments.dry_run) host::disable_and_wait(board, mask);
  report(arguments, "disable", {{"axes", arguments.axes}});
  if (talks(arguments)) fmt::print("{}\n", arguments.dry_run ? "would disable" : "disabled");
}

void jog(const MotionArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const std::uint8_t axis = axis_index(arguments.axis, board.axis_count());
  board.require_same_table();
  const firmware::ParameterValues values = board.read_values();
  host::require_reachable(values, axis, arguments.value);
  const double before = position_of(board, axis, values);
  catch_interrupts();
  if (!arguments.dry_run && arguments.take_over) board.take_over();
  if (!arguments.dry_run)
    host::jog_for(board, axis, arguments.value, std::chrono::duration<double>(arguments.duration_s), interrupted);
  const double after = position_of(board, axis, values);
  report(arguments, "jog", {{"axis", arguments.axis}, {"from", before}, {"to", after}});
  if (!arguments.dry_run) host::require_no_contact(board, values);
  if (!talks(arguments)) return;
  if (arguments.dry_run)
    fmt::print("would jog {} at {:g} {}/s for {:g} s\n", arguments.axis, arguments.value,
               host::travel_unit(axis, values), arguments.duration_s);
  else
    fmt::print("{} moved from {:.4f} to {:.4f} {}{}\n", arguments.axis, before, after, host::travel_unit(axis, values),
               interrupted() ? " (interrupted)" : "");
}

/// Asks before a long move without travel limits.
void ask_without_travel(const MotionArguments& arguments, const firmware::AxisValues& values, double way) {
  if (!host::is_long_without_limits(values, way)) return;
  require_consent(arguments, fmt::format("Move {} by {:g}? That is more than homing.travel = {:g}, and "
                                         "monitor.travel_min and monitor.travel_max are not set.",
                                         arguments.axis, way, values.get<"homing.travel">()));
}

void move(const MotionArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const std::uint8_t axis = axis_index(arguments.axis, board.axis_count());
  board.require_same_table();
  const firmware::ParameterValues values = board.read_values();
  const double before = position_of(board, axis, values);
  const double target = arguments.relative ? before + arguments.value : arguments.value;
  host::counts_of(target, values.axis(axis));
  if (!arguments.dry_run) ask_without_travel(arguments, values.axis(axis), target - before);
  catch_interrupts();
  if (!arguments.dry_run && arguments.take_over) board.take_over();
  const double way = arguments.relative ? arguments.value : target;
  if (!arguments.dry_run)
    host::move_and_wait(board, axis, host::counts_of(way, values.axis(axis)), arguments.relative, interrupted);
  const double after = position_of(board, axis, values);
  report(arguments, "move", {{"axis", arguments.axis}, {"from", before}, {"target", target}, {"to", after}});
  if (!arguments.dry_run) host::require_no_contact(board, values);
  if (!talks(arguments)) return;
  fmt::print("{} {} {:.4f} {unit} from {:.4f} {unit}{}\n", arguments.axis,
             arguments.dry_run ? "would move to" : "is at", arguments.dry_run ? target : after, before,
             interrupted() ? " (interrupted)" : "", fmt::arg("unit", host::travel_unit(axis, values)));
}

void add_take_over(CLI::App& command, MotionArguments& arguments) {
  command.add_flag("--take-over", arguments.take_over, "take control of the axes from another program");
}

/// Sets the homing mode with the loop open, then closes the loop again. Needs the same consent as `enable`.
void set_homing(const MotionArguments& arguments, host::BoardClient& board, std::uint8_t axis) {
  const auto mask = static_cast<std::uint8_t>(1u << axis);
  require_consent(arguments, fmt::format("Close the control loop of axis {} and home it? It moves.", arguments.axis));
  if (host::are_enabled(board, mask)) host::disable_and_wait(board, mask);
  firmware::ParameterValues values = board.read_values();
  const auto set = [&](const char* name, double value) {
    values.set(host::require_place(fmt::format("{}.{}", arguments.axis, name)), static_cast<float>(value));
  };
  if (!arguments.mode.empty())
    set("homing.mode", static_cast<double>(std::ranges::find(kHomingModes, arguments.mode) - kHomingModes.begin()));
  if (arguments.speed != 0.0) set("homing.velocity", arguments.speed);
  board.write_values(values);
  host::enable_and_wait(board, mask);
}

void home(const MotionArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const std::uint8_t axis = axis_index(arguments.axis, board.axis_count());
  board.require_same_table();
  const bool sets = !arguments.mode.empty() || arguments.speed != 0.0;
  if (sets && !arguments.dry_run) set_homing(arguments, board, axis);
  const firmware::ParameterValues values = board.read_values();
  const auto mode = static_cast<std::size_t>(values.axis(axis).get<"homing.mode">());
  if (mode == 0 && !arguments.here && arguments.mode.empty())
    throw host::Failure(host::ExitCode::refused,
                        fmt::format("axis {} has no homing method (homing.mode is 0): axistool home {} --mode switch, "
                                    "index or both; or --here if it stands at home",
                                    arguments.axis, arguments.axis));
  catch_interrupts();
  if (!arguments.dry_run) {
    if (arguments.take_over) board.take_over();
    if (arguments.here)
      board.home(axis, true);
    else
      host::home_and_wait(board, axis, interrupted);
  }
  const bool homed = (board.status().axis.at(axis).flags & firmware::kAxisHomed) != 0;
  const double at = position_of(board, axis, values);
  report(arguments, "home", {{"axis", arguments.axis}, {"homed", homed}, {"at", at}, {"mode", kHomingModes.at(mode)}});
  if (!arguments.dry_run && !arguments.here) host::require_no_contact(board, values);
  if (!talks(arguments)) return;
  if (arguments.dry_run)
    fmt::print("would {}\n", arguments.here ? "use the present place as home" : "look for home");
  else
    fmt::print("{} {}{}, at {:.4f} {}{}\n", arguments.axis, homed ? "is homed" : "is not homed (interrupted)",
               arguments.here ? std::string(" where it stands") : fmt::format(" by {}", kHomingModes.at(mode)), at,
               host::travel_unit(axis, values), sets ? "; `axistool save` keeps its mode" : "");
}

}  // namespace

void add_enable(CLI::App& app) {
  auto arguments = std::make_shared<MotionArguments>();
  CLI::App* command = app.add_subcommand("enable", "Close the control loop of axes");
  command->add_option("AXIS", arguments->axes, "x, y, …; default: all axes of the board");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  add_take_over(*command, *arguments);
  command->footer("Example:\n  axistool enable x --yes\nAsks before; in a script give --yes.");
  command->callback([arguments] { enable(*arguments); });
}

void add_disable(CLI::App& app) {
  auto arguments = std::make_shared<MotionArguments>();
  CLI::App* command = app.add_subcommand("disable", "Slow axes down and open their control loop");
  command->add_option("AXIS", arguments->axes, "x, y, …; default: all axes of the board");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer("Example:\n  axistool disable");
  command->callback([arguments] { disable(*arguments); });
}

void add_jog(CLI::App& app) {
  auto arguments = std::make_shared<MotionArguments>();
  CLI::App* command = app.add_subcommand("jog", "Move an enabled axis at a speed, for a time");
  command->add_option("AXIS", arguments->axis, "x, y, …")->required();
  command->add_option("SPEED", arguments->value, "mm/s (linear drive: m/s), negative for the other direction")
      ->required();
  command->add_option("--for", arguments->duration_s, "seconds until it slows down")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 3600.0));
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  add_take_over(*command, *arguments);
  command->footer("Example:\n  axistool jog x -20 --for 2\nCtrl-C slows down at once.");
  command->callback([arguments] { jog(*arguments); });
}

void add_home(CLI::App& app) {
  auto arguments = std::make_shared<MotionArguments>();
  CLI::App* command = app.add_subcommand("home", "Home an enabled axis: find the origin of its positions");
  command->add_option("AXIS", arguments->axis, "x, y, …")->required();
  command->add_flag("--here", arguments->here, "if homing.mode is 0: the present place is homing.position");
  command
      ->add_option("--mode", arguments->mode,
                   "how to home: switch, index, or both (switch, then index); sets homing.mode and closes the loop")
      ->check(CLI::IsMember({"switch", "index", "both"}));
  command->add_option("--speed", arguments->speed,
                      "speed towards the switch or index, mm/s (linear drive: m/s), negative for the other direction; "
                      "sets homing.velocity");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  add_take_over(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool home x --mode both --speed 20 --yes\n"
      "  axistool home x\n"
      "  axistool home y --here\n"
      "homing.mode selects: switch (1), index (2), or switch and then index (3). Until an axis is homed it refuses "
      "moves to\n"
      "a position, and travel limits and compensation of cogging and of friction along the travel are inactive. A "
      "reset\n"
      "clears home.");
  command->callback([arguments] { home(*arguments); });
}

void add_move(CLI::App& app) {
  auto arguments = std::make_shared<MotionArguments>();
  CLI::App* command = app.add_subcommand("move", "Move an enabled axis to a position and wait for it");
  command->add_option("AXIS", arguments->axis, "x, y, …")->required();
  command->add_option("POSITION", arguments->value, "mm (linear drive: m)")->required();
  command->add_flag("--relative", arguments->relative, "from the present position");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  add_take_over(*command, *arguments);
  command->footer(
      "Examples:\n  axistool move x 100\n  axistool move y -5 --relative\nTo a POSITION only once the axis is homed: "
      "axistool home.");
  command->callback([arguments] { move(*arguments); });
}

}  // namespace axistool
