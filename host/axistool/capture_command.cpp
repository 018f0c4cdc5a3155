// axistool capture: samples of a board at loop rate, as a record.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/interrupts.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/capture.hpp"
#include "host/device/capture_journal.hpp"
#include "host/device/closed_loops.hpp"
#include "host/device/motion.hpp"
#include "host/device/quantity.hpp"
#include "host/device/triggered_capture.hpp"
#include "host/identify/force_estimate.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/record/read_record.hpp"
#include "host/report/progress.hpp"

namespace axistool {

namespace {

struct CaptureArguments : DeviceArguments {
  std::string output, axis = "x", trigger, drive, sheet, model;
  std::vector<std::string> channels, jogs;
  std::string before;
  double duration_s = 0.0, wait_s = 60.0;
  unsigned every = 1;
  bool linear = false, wide = false, last = false;
};

/// "0.05", "50ms", "2s".
double seconds_of(const std::string& text) {
  if (text.empty()) return 0.0;
  const auto [value, unit] = host::parse_quantity(text).value_or(host::Quantity{-1.0, {}});
  const double factor = unit.empty() || unit == "s" ? 1.0 : unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 0.0;
  if (factor == 0.0 || !(value >= 0.0) || value * factor > 3600.0)
    throw host::Failure(host::ExitCode::usage, fmt::format("--pre {}: write seconds, or 50ms", text));
  return value * factor;
}

host::CaptureSettings settings_of(const CaptureArguments& arguments, const firmware::ParameterValues& values) {
  host::CaptureSettings settings;
  settings.axis = axis_index(arguments.axis, values.axes());
  settings.kind = arguments.linear ? sim::DriveKind::linear : sim::DriveKind::rotary;
  for (const std::string& name : arguments.channels)
    settings.channels.push_back(host::channel_named(name, settings.kind));
  if (arguments.channels.empty())
    settings.channels = host::usual_channels(values.axis(settings.axis).get<"tachometer.fitted">());
  if (!arguments.trigger.empty() && !host::is_board_trigger(arguments.trigger)) {
    settings.trigger = host::parse_trigger(arguments.trigger, settings.kind);
    settings.channels.push_back(settings.trigger->channel);
  }
  using firmware::Channel;
  if (!arguments.model.empty())
    for (const Channel one : {Channel::counts, Channel::reference_velocity, Channel::disturbance, Channel::friction})
      settings.channels.push_back(one);
  std::ranges::sort(settings.channels);
  settings.channels.erase(std::unique(settings.channels.begin(), settings.channels.end()), settings.channels.end());
  settings.every = static_cast<std::uint16_t>(arguments.every);
  settings.before_s = seconds_of(arguments.before);
  settings.patience_s = arguments.wait_s;
  for (const std::string& jog : arguments.jogs) settings.jogs.push_back(host::parse_jog(jog));
  settings.duration_s = arguments.duration_s > 0.0 || !settings.jogs.empty() ? arguments.duration_s : 1.0;
  return settings;
}

/// Adds the scale on the table to the record if the board has one and the data sheet gives its resolution.
void settle_scale(const CaptureArguments& arguments, host::BoardClient& board, host::CaptureSettings& settings) {
  constexpr firmware::Channel kScale = firmware::Channel::table_counts;
  if (!arguments.sheet.empty())
    settings.table_resolution = host::read_drive(arguments.sheet).data.load_encoder_resolution;
  const bool is_asked = std::ranges::find(settings.channels, kScale) != settings.channels.end();
  if (!is_asked && !(settings.table_resolution > 0.0)) return;
  const bool is_there = (board.status().axis.at(settings.axis).flags & firmware::kAxisScale) != 0;
  const std::string name = host::channel_name(kScale, settings.kind);
  if (is_asked && !is_there)
    throw host::Failure(host::ExitCode::refused,
                        fmt::format("axis {} of this board has no second encoder, so there is no {}: leave it out",
                                    arguments.axis, name));
  if (is_asked && !(settings.table_resolution > 0.0))
    throw host::Failure(host::ExitCode::usage,
                        fmt::format("{} needs the resolution of the scale: --sheet DRIVE.toml, with "
                                    "[drive.load_encoder] in it",
                                    name));
  const bool in_memory = arguments.last || host::is_board_trigger(arguments.trigger);
  if (is_asked && in_memory)
    throw host::Failure(host::ExitCode::usage,
                        fmt::format("the board's own memory does not hold {}: leave it out, or the axis's name out of "
                                    "the trigger",
                                    name));
  if (is_asked || in_memory || !arguments.channels.empty()) return;
  if (is_there)
    settings.channels.push_back(kScale);
  else if (talks(arguments))
    fmt::print(stderr, "axistool: axis {} of this board has no second encoder: the record has no {}\n", arguments.axis,
               name);
}

const std::string& name_of_drive(const CaptureArguments& arguments) {
  return arguments.drive.empty() ? arguments.axis : arguments.drive;
}

void write(const CaptureArguments& arguments, const host::Capture& capture, const host::CaptureSettings& settings,
           const firmware::AxisValues& board) {
  host::Record record = host::capture_record(capture, settings, name_of_drive(arguments));
  if (!arguments.model.empty())
    host::add_process_force(record, host::read_model(arguments.model), host::estimator_of(board));
  host::write_record(record, arguments.output);
  nlohmann::json document{{"format", "axis-capture/1"}, {"file", arguments.output},
                          {"rows", record.size()},      {"sample_period_s", record.sample_period_s},
                          {"lost_rows", capture.lost},  {"dropped_by_board", capture.dropped_by_board},
                          {"cut_short", interrupted()}};
  if (capture.trigger_s) document["trigger_s"] = *capture.trigger_s;
  if (!arguments.json.empty()) write_json(document, arguments.json);
  if (talks(arguments))
    fmt::print("{} rows at {:g} Hz in {}, {} lost{}\n", record.size(), 1.0 / record.sample_period_s, arguments.output,
               capture.lost, interrupted() ? "; ended by a signal" : "");
}

/// Capture in the board's own memory, at loop rate, independent of the connection's speed.
void run_on_board(const CaptureArguments& arguments, host::BoardClient& board, host::CaptureSettings settings,
                  const firmware::AxisValues& values) {
  host::TriggeredSettings wanted;
  wanted.wide = arguments.wide;
  wanted.capture = std::move(settings);
  if (arguments.last) {
    const host::Capture capture = host::read_triggered_capture(board, wanted);
    write(arguments, capture, wanted.capture, values);
    return;
  }
  wanted.trigger = host::parse_board_trigger(arguments.trigger, wanted.capture.kind);
  if (arguments.duration_s == 0.0) wanted.capture.duration_s = std::max(0.1, wanted.capture.before_s);
  if (wanted.trigger.axis != firmware::kAnyAxis && wanted.trigger.axis >= board.axis_count())
    throw host::Failure(host::ExitCode::usage, fmt::format("{}: the board has no such axis", arguments.trigger));
  if (arguments.dry_run) return;
  catch_interrupts();
  write(arguments, host::run_triggered_capture(board, wanted, interrupted), wanted.capture, values);
}

void run(const CaptureArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const firmware::ParameterValues values = board.read_values();
  host::CaptureSettings settings = settings_of(arguments, values);
  settle_scale(arguments, board, settings);
  const firmware::AxisValues axis = values.axis(settings.axis);
  if (arguments.last || host::is_board_trigger(arguments.trigger))
    return run_on_board(arguments, board, settings, axis);
  host::require_capturable(values, settings);
  if (!axis.get<"drive.fitted">() && talks(arguments))
    fmt::print(stderr,
               "axistool: axis {} is not fitted: counts and volts use the board's initial scales, and nothing moves; "
               "first set-params the file that `design` wrote\n",
               arguments.axis);
  const double rate_Hz = static_cast<double>(values.get<"control.rate">()) / settings.every;
  if (arguments.dry_run) {
    if (talks(arguments))
      fmt::print("would capture {} channels at {:g} Hz into {}\n", settings.channels.size(), rate_Hz, arguments.output);
    return;
  }
  double seconds = settings.duration_s;
  for (const host::JogStep& jog : settings.jogs) seconds += arguments.duration_s > 0.0 ? 0.0 : jog.duration_s;
  const auto mask = static_cast<std::uint8_t>(1u << settings.axis);
  std::optional<host::ClosedLoops> loop;
  if (!settings.jogs.empty()) {
    if (!host::are_enabled(board, mask))
      require_consent(arguments, fmt::format("Enable axis {} and jog it?", arguments.axis));
    loop.emplace(board, mask);
  }
  host::Capture capture;
  host::CaptureJournal journal(arguments.output, settings, name_of_drive(arguments));
  {
    host::Progress progress("capture", std::max<std::size_t>(1, static_cast<std::size_t>(seconds * rate_Hz)));
    std::size_t shown = 0;
    catch_interrupts();
    try {
      capture = host::run_capture(board, settings, [&](const host::Capture& so_far) {
        const std::size_t rows = so_far.number.size();
        if (rows > shown) progress.advance(rows - shown);
        shown = std::max(shown, rows);
        journal.keep(so_far);
        return !interrupted();
      });
    } catch (const host::Failure& failure) {
      throw host::Failure(failure.code, failure.what() + journal.remark());
    }
  }
  if (loop) loop->open();
  write(arguments, capture, settings, axis);
  journal.remove();
  host::require_no_loss(capture, arguments.output);
}

}  // namespace

void add_capture(CLI::App& app) {
  auto arguments = std::make_shared<CaptureArguments>();
  CLI::App* command = app.add_subcommand("capture", "Record an axis at loop rate while it moves -> record");
  add_output(*command, "-o,--output", arguments->output, "record to write (axis-record/1)")->required();
  command->add_option("AXIS,--axis", arguments->axis, "x, y, …")->capture_default_str();
  command
      ->add_option("--for", arguments->duration_s,
                   "seconds, from the trigger if there is one; default: 1, or the duration of the jogs")
      ->check(CLI::Range(0.0, 86400.0));
  command
      ->add_option("--channels", arguments->channels,
                   "names, separated by commas; default: u_V, x_mm, w_rad_s, x_ref_mm, w_ref_rad_s")
      ->delimiter(',');
  command->add_option("--every", arguments->every, "take every n-th control period")
      ->capture_default_str()
      ->check(CLI::Range(1u, 65535u));
  command->add_option(
      "--trigger", arguments->trigger,
      "start when a channel crosses a level: 'w_rad_s>5', 'x_mm<0'; with an axis name the board checks every sample "
      "itself and records into its memory: 'x.position_error > 20um', 'x.fault', 'any.fault', 'x.motion', 'x.now'");
  command->add_option("--pre", arguments->before, "time to keep before the trigger: 0.1, 50ms");
  command->add_flag("--wide", arguments->wide,
                    "in the board's memory: keep full precision of speeds, errors and voltages");
  command->add_flag("--last", arguments->last,
                    "read the capture in the board's memory, even from before its last reset");
  command->add_option("--wait", arguments->wait_s, "seconds to wait for the trigger")->capture_default_str();
  command
      ->add_option("--jog", arguments->jogs,
                   "SPEED:SECONDS, jogs to run one after the other during the capture; the axis is enabled for that "
                   "time if it is not yet")
      ->delimiter(',');
  command->add_flag("--linear", arguments->linear, "the drive is linear: m and m/s");
  command->add_option("--drive", arguments->drive, "name of the drive in the record; default: the axis");
  add_input(*command, "--sheet", arguments->sheet,
            "data sheet of the drive; with [drive.load_encoder] the record also has the table position from the scale, "
            "x2_mm");
  add_input(
      *command, "--model", arguments->model,
      "model of the drive: the record also has the process force on the table, process_force_N, with its 95 % band "
      "in the header");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool capture -o idle.csv --for 2\n"
      "  axistool capture -o jogs.csv --jog 20:1,-20:1\n"
      "  axistool capture -o bump.csv --trigger 'd_hat_V>0.5' --pre 0.1 --for 0.4 --channels u_V,x_mm,d_hat_V\n"
      "  axistool capture -o error.csv --trigger 'x.position_error > 20um' --pre 50ms\n"
      "Channels beyond the default: x_err_mm, w_hat_rad_s, d_hat_V, u_friction_V, u_control_V, flags, x2_mm.\n"
      "Lost rows are counted and give exit code 5; the file keeps the gap.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
