#include "host/workbench/live.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "firmware/core/supervision/fault_table.hpp"
#include "host/device/board_report.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/open_board.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/parameters/parameter_names.hpp"
#include "host/record/read_record.hpp"
#include "host/report/text_format.hpp"
#include "host/workbench/envelope_text.hpp"

namespace host::workbench {

namespace {

using nlohmann::json;
using Action = MotionRequest::Action;

OpenBoard opener(const LiveDevice& device) {
  if (device.device.starts_with("model:") || device.device.starts_with("plant:"))
    throw Failure(ExitCode::usage,
                  "serve needs a board in real time: start `axistool sim` with the model, then serve --device sim");
  return [device] { return open_board(device.device, std::chrono::duration<double>(device.patience_s)); };
}

json fault_json(const firmware::AxisStatus& axis) {
  if (axis.fault == 0) return nullptr;
  const firmware::FaultInfo& fault = firmware::fault_info(static_cast<firmware::AxisFault>(axis.fault));
  return {{"name", fault.name}, {"cause", fault.cause}, {"remedy", fault.remedy}};
}

const char* phase_name(WatchedTrigger::Phase phase) {
  constexpr std::array kNames{"idle", "waiting", "done", "failed"};
  return kNames.at(static_cast<std::size_t>(phase));
}

/// Throws Failure(refused) for a move of which the command would ask whether it is meant.
void require_known_way(const BoardPicture& picture, std::size_t axis, double position) {
  const auto place = place_of_counts(picture.status.axis.at(axis).counts(), axis, &picture.values);
  if (place && is_long_without_limits(picture.values.axis(axis), position - place->value))
    throw Failure(ExitCode::refused,
                  "this way is longer than homing.travel, and the axis has no travel limits: set "
                  "monitor.travel_min and monitor.travel_max first");
}

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

}  // namespace

Live::Live(const Folder& folder, const LiveDevice& device)
    : folder_(folder),
      device_(device),
      watch_(opener(device)),
      command_(opener(device), [this] { return ownership_.is_there(Clock::now()); }) {}

std::string Live::command(const std::string& words) const {
  return fmt::format("axistool {} --device {}", words, shell_word(device_.device));
}

void Live::require_free(const std::string& owner) const {
  require_command(owner);
  if (is_commissioning_)
    throw Failure(ExitCode::refused, "a commissioning uses the axes: wait for its end, or cancel it");
}

json Live::description() const {
  const BoardPicture picture = watch_.picture();
  json axes = json::array(), channels = json::array(), streamed = json::array();
  for (std::size_t axis = 0; axis < picture.values.axes(); ++axis) {
    const firmware::AxisValues values = picture.values.axis(axis);
    axes.push_back({{"name", firmware::kAxisNames.at(axis)},
                    {"unit", travel_unit(axis, picture.values)},
                    {"fitted", values.get<"drive.fitted">()},
                    {"velocity", values.get<"limits.velocity">()},
                    {"homes", values.get<"homing.mode">() != 0}});
  }
  for (const WatchedChannel& one : all_channels(picture.values.axes()))
    channels.push_back({{"name", name_of(one, picture.kinds)}, {"unit", unit_of(one, picture.kinds)}});
  for (const WatchedChannel& one : picture.channels) streamed.push_back(name_of(one, picture.kinds));
  return {{"board", picture.name},           {"device", device_.device},
          {"epoch", picture.epoch},          {"period_s", picture.row_period_s},
          {"axes", std::move(axes)},         {"channels", std::move(channels)},
          {"streamed", std::move(streamed)}, {"most", firmware::kWordsPerReport}};
}

json Live::state() const {
  const BoardPicture picture = watch_.picture();
  json axes = json::array();
  for (std::size_t axis = 0; axis < picture.status.axis.size(); ++axis) {
    const firmware::AxisStatus& now = picture.status.axis[axis];
    const auto place = place_of_counts(now.counts(), axis, &picture.values);
    axes.push_back({{"state", state_text(now)},
                    {"position", place ? json(place->value) : json(nullptr)},
                    {"velocity", number_or_null(static_cast<double>(now.velocity))},
                    {"at_rest", (now.flags & firmware::kAxisAtRest) != 0},
                    {"homed", (now.flags & firmware::kAxisHomed) != 0},
                    {"homing", (now.flags & firmware::kAxisHoming) != 0},
                    {"fault", fault_json(now)}});
  }
  return {{"connected", picture.is_connected},
          {"message", picture.message},
          {"epoch", picture.epoch},
          {"begin", picture.begin},
          {"end", picture.end},
          {"lost", picture.lost},
          {"repeated", picture.repeated},
          {"owner", ownership_.number(Clock::now())},
          {"emergency_stop", (picture.status.flags & firmware::kBoardStopPressed) != 0},
          {"unsaved", (picture.status.flags & firmware::kBoardUnsaved) != 0},
          {"axes", std::move(axes)},
          {"trigger", {{"phase", phase_name(picture.trigger.phase)}, {"text", picture.trigger.text}}}};
}

json Live::rows(const RowsRequest& range, std::size_t points) const {
  const BoardPicture picture = watch_.picture();
  const std::uint64_t to = std::min(range.to, picture.end), wanted = to > range.from ? to - range.from : 1;
  std::uint64_t rows = std::max<std::uint64_t>(1, wanted / std::clamp<std::size_t>(points, 1, 4000));
  if (range.from < picture.begin) rows = (rows / SampleRing::kStep + 1) * SampleRing::kStep;
  const auto envelope = watch_.envelope(range.epoch, range.from, to, rows);
  if (!envelope) throw Failure(ExitCode::refused, "these rows are no longer kept: another stream has begun");
  return json::parse(envelope_text(*envelope, range.epoch));
}

std::string Live::next_event(View& view) const {
  const BoardPicture picture = watch_.picture();
  if (picture.epoch != view.epoch) {
    view.epoch = picture.epoch;
    view.next = picture.end > view.back ? picture.end - view.back : 0;
  }
  const auto envelope = watch_.envelope(view.epoch, view.next, picture.end, view.rows);
  if (!envelope || envelope->taken.empty()) return "";
  view.next = envelope->first + envelope->taken.size() * envelope->rows;
  return fmt::format("event: rows\nid: {}-{}\ndata: {}\n\n", view.epoch, view.next,
                     envelope_text(*envelope, view.epoch));
}

std::string Live::claim() {
  std::string key = ownership_.claim(Clock::now());
  try {
    command_.take();
  } catch (const Failure&) {
    ownership_.drop();
    throw;
  }
  return key;
}

void Live::release(const std::string& owner) {
  ownership_.require(owner, Clock::now());
  stop();
}

void Live::stop() {
  ownership_.drop();
  command_.stop();
}

std::string Live::move(const MotionRequest& request) {
  require_free(request.owner);
  const BoardPicture picture = watch_.picture();
  const bool is_of_all = request.axis.empty();
  const std::uint8_t axis = is_of_all ? std::uint8_t{0} : axis_index(request.axis, picture.values.axes());
  const auto mask = static_cast<std::uint8_t>(1u << axis);
  if (request.action == Action::jog) require_reachable(picture.values, axis, request.velocity);
  if (request.action == Action::move) require_known_way(picture, axis, request.position);
  if (request.action == Action::home && picture.values.axis(axis).get<"homing.mode">() == 0)
    throw Failure(ExitCode::refused, fmt::format("axis {0} has no homing method: set {0}.homing.mode, or take the "
                                                 "present place as home",
                                                 request.axis));
  std::string words;
  command_.with([&](BoardClient& board) {
    switch (request.action) {
      case Action::enable:
        if (!board.enable_at_rest(mask))
          throw Failure(ExitCode::refused, "the axis moves, or its amplifier still reports ready: wait");
        words = fmt::format("enable {}", request.axis);
        break;
      case Action::disable:
        board.disable(mask);
        words = fmt::format("disable {}", request.axis);
        break;
      case Action::jog:
        board.jog(axis, request.velocity);
        words = fmt::format("jog {} {:g}", request.axis, request.velocity);
        break;
      case Action::move:
        board.move(axis, counts_of(request.position, picture.values.axis(axis)));
        words = fmt::format("move {} {:g}", request.axis, request.position);
        break;
      case Action::halt:
        board.stop();
        break;
      case Action::home:
      case Action::home_here:
        board.home(axis, request.action == Action::home_here);
        words = fmt::format("home {}{}", request.axis, request.action == Action::home_here ? " --here" : "");
        break;
      case Action::clear_faults:
        board.clear_faults();
        words = "clear-faults";
        break;
    }
  });
  return words.empty() ? "" : command(words);
}

void Live::choose(const std::vector<std::string>& names) {
  watch_.choose(watched_channels(names, watch_.picture().kinds));
}

std::string Live::arm(const TriggerWish& wish) {
  const BoardPicture picture = watch_.picture();
  TriggeredSettings settings;
  settings.capture.axis = axis_index(wish.axis, picture.values.axes());
  settings.capture.kind = picture.kinds.at(settings.capture.axis);
  for (const WatchedChannel& one : picture.channels)
    if (one.axis == settings.capture.axis) settings.capture.channels.push_back(one.channel);
  if (settings.capture.channels.empty())
    settings.capture.channels = usual_channels(picture.values.axis(settings.capture.axis).get<"tachometer.fitted">());
  settings.capture.before_s = wish.before_s;
  settings.capture.duration_s = wish.after_s;
  settings.capture.patience_s = 3600.0;
  if (!is_board_trigger(wish.trigger)) throw Failure(ExitCode::usage, "write for example 'x.position_error > 20um'");
  settings.trigger = parse_board_trigger(wish.trigger, settings.capture.kind);
  if (settings.trigger.axis != firmware::kAnyAxis)
    axis_index(wish.trigger.substr(0, wish.trigger.find('.')), picture.values.axes());
  std::vector<std::string> names;
  for (const firmware::Channel one : settings.capture.channels)
    names.push_back(channel_name(one, settings.capture.kind));
  const std::string drive = wish.axis;
  watch_.arm(settings, [this, drive](const Capture& capture, const CaptureSettings& taken) {
    const std::string name = folder_.free_name("trigger-" + drive, ".csv");
    write_record(capture_record(capture, taken, drive), name);
    return name;
  });
  return command(fmt::format("capture {} --trigger {} --pre {:g} --for {:g} --channels {} -o trigger-{}.csv", wish.axis,
                             shell_word(wish.trigger), wish.before_s, wish.after_s, fmt::join(names, ","), wish.axis));
}

std::vector<std::string> Live::save(const RowsRequest& range) const {
  const BoardPicture picture = watch_.picture();
  std::vector<std::string> names;
  for (std::uint8_t axis = 0; axis < picture.values.axes(); ++axis) {
    if (std::ranges::count(picture.channels, axis, &WatchedChannel::axis) == 0) continue;
    CaptureSettings settings;
    const Capture capture = watch_.rows(range.epoch, axis, range.from, range.to, settings);
    if (std::ranges::count(settings.channels, firmware::Channel::counts) == 0)
      throw Failure(ExitCode::refused, fmt::format("a record of axis {} needs its position among the channels",
                                                   firmware::kAxisNames[axis]));
    if (capture.number.size() < kFewestRows)
      throw Failure(ExitCode::refused, fmt::format("a record has at least {} rows", kFewestRows));
    const std::string drive(firmware::kAxisNames[axis]);
    names.push_back(folder_.free_name("live-" + drive, ".csv"));
    write_record(capture_record(capture, settings, drive), names.back());
  }
  return names;
}

json Live::parameters() const {
  const BoardPicture picture = watch_.picture();
  json list = json::array();
  for (std::size_t place = 0; place < picture.values.size(); ++place) {
    const firmware::ParameterInfo& info = info_at(place);
    const bool is_linear_axis =
        firmware::key_at(place).owner() > 0 && is_linear(firmware::key_at(place).owner() - 1, picture.values);
    list.push_back({{"name", full_name(place)},
                    {"unit", is_linear_axis ? info.linear_unit : info.unit},
                    {"type", info.type == firmware::ParameterType::toggle  ? "toggle"
                             : info.type == firmware::ParameterType::whole ? "whole"
                                                                           : "real"},
                    {"minimum", value_text(info, info.minimum)},
                    {"maximum", value_text(info, info.maximum)},
                    {"initial", value_text(info, info.initial)},
                    {"value", value_text(info, picture.values.at(place))},
                    {"any_time", info.change != firmware::ParameterChange::while_disabled},
                    {"doc", info.doc}});
  }
  const std::lock_guard lock(mutex_);
  return {{"parameters", std::move(list)}, {"undo", before_.size()}};
}

json Live::staged(const ParameterText& file) const {
  json values = json::object();
  for (const Assignment& one : parse_parameter_text(file.text, file.name, file.axis))
    values[full_name(one.place)] = value_text(info_at(one.place), one.value);
  return values;
}

std::string Live::set(const ParametersRequest& request) {
  require_free(request.owner);
  std::vector<std::pair<std::size_t, float>> before;
  command_.with([&](BoardClient& board) {
    const firmware::ParameterValues old = board.read_values();
    firmware::ParameterValues values = old;
    for (const std::string& one : request.assignments) put(values, parse_assignment(one));
    require_fitting_set(values);
    board.write_values(values);
    for (std::size_t place = 0; place < values.size(); ++place)
      if (std::bit_cast<std::uint32_t>(old.at(place)) != std::bit_cast<std::uint32_t>(values.at(place)))
        before.emplace_back(place, old.at(place));
  });
  watch_.look_again();
  if (!before.empty()) {
    const std::lock_guard lock(mutex_);
    before_.push_back(std::move(before));
  }
  std::string words = "set-params";
  for (const std::string& one : request.assignments) words += " " + shell_word(one);
  return command(words);
}

void Live::undo(const std::string& owner) {
  require_free(owner);
  const std::lock_guard lock(mutex_);
  if (before_.empty()) throw Failure(ExitCode::refused, "nothing was changed in this session");
  command_.with([&](BoardClient& board) {
    firmware::ParameterValues values = board.read_values();
    for (const auto& [place, value] : before_.back()) values.set(place, value);
    require_fitting_set(values);
    board.write_values(values);
  });
  before_.pop_back();
  watch_.look_again();
}

void Live::keep(const std::string& owner) {
  require_free(owner);
  command_.with([](BoardClient& board) { board.save(); });
}

}  // namespace host::workbench
