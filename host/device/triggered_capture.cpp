#include "host/device/triggered_capture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "firmware/app/channel_words.hpp"
#include "firmware/app/parameters/axis_values.hpp"
#include "host/device/quantity.hpp"
#include "host/exit_codes.hpp"
#include "host/number.hpp"

namespace host {

namespace {

using firmware::Channel;
using firmware::TriggerKind;
using firmware::TriggerPhase;

/// Names of signals; column names are accepted, too.
struct ChannelWord {
  std::string_view name;
  Channel channel;
};
constexpr std::array kChannelWords{ChannelWord{"command", Channel::dac_code},
                                   ChannelWord{"position", Channel::counts},
                                   ChannelWord{"speed", Channel::velocity_estimate},
                                   ChannelWord{"tachometer", Channel::tachometer_velocity},
                                   ChannelWord{"reference", Channel::reference},
                                   ChannelWord{"reference_speed", Channel::reference_velocity},
                                   ChannelWord{"position_error", Channel::position_error},
                                   ChannelWord{"disturbance", Channel::disturbance},
                                   ChannelWord{"friction", Channel::friction},
                                   ChannelWord{"control", Channel::control}};

Channel channel_called(std::string_view name, sim::DriveKind kind) {
  for (const ChannelWord& word : kChannelWords)
    if (word.name == name) return word.channel;
  try {
    // The board's own memory does not hold the scale on the table.
    if (const Channel channel = channel_named(name, kind); channel != Channel::table_counts) return channel;
  } catch (const Failure&) {
    // The names of the signals are listed below.
  }
  std::vector<std::string_view> names;
  for (const ChannelWord& word : kChannelWords) names.push_back(word.name);
  throw Failure(ExitCode::usage,
                fmt::format("no signal is called {}; there are {}, fault and motion", name, fmt::join(names, ", ")));
}

/// "20um", "0.5V"; "12" if the channel's name contains the unit, or the channel has none.
double level_of(std::string_view text, sim::DriveKind kind, bool has_unit_in_name) {
  const std::optional<Quantity> written = parse_quantity(trim_blanks(text));
  const std::string_view unit = written ? trim_blanks(written->unit) : "";
  if (written && unit.empty() && !has_unit_in_name)
    throw Failure(ExitCode::usage,
                  fmt::format("{}: a level without unit; write it after the number: um, mm, m, mm/s, m/s, rad/s or V",
                              trim_blanks(text)));
  const bool is_own = unit.empty() || unit == "V" || unit == "rad/s" || unit == "m/s";
  const double factor = is_own ? 1.0 : length_factor(unit == "mm/s" ? "mm" : unit, kind);
  if (!written || factor == 0.0 || !std::isfinite(written->value))
    throw Failure(ExitCode::usage,
                  fmt::format("{}: not a level; write a number with um, mm, m, mm/s, m/s, rad/s or V", text));
  return written->value * factor;
}

/// The level as a word of its channel.
std::uint32_t level_word(const BoardTrigger& trigger, const firmware::AxisValues& axis, bool fixed_point) {
  const double resolution = static_cast<double>(axis.get<"drive.encoder_resolution">());
  const auto whole = [](double value) {
    return static_cast<std::uint32_t>(std::llround(std::clamp(value, -2147483648.0, 2147483647.0)));
  };
  if (trigger.channel == Channel::dac_code)
    return whole(trigger.level / static_cast<double>(axis.get<"drive.dac_resolution">()));
  if (trigger.channel == Channel::counts) return whole(trigger.level / resolution);
  if (trigger.channel == Channel::reference) return whole(trigger.level / resolution * 256.0);
  if (!fixed_point) return std::bit_cast<std::uint32_t>(static_cast<float>(trigger.level));
  const firmware::FixedUnits<float> unit(firmware::axis_parameters<float>(axis));
  const bool is_volts = trigger.channel == Channel::disturbance || trigger.channel == Channel::friction ||
                        trigger.channel == Channel::control;
  const float one = is_volts ? unit.volts : trigger.channel == Channel::position_error ? unit.length : unit.velocity;
  return whole(trigger.level / static_cast<double>(one) * (1 << 21));
}

/// Extends half words to the words of a stream: the missing upper half is tracked from row to row.
class Widener {
 public:
  explicit Widener(std::int64_t counts_at_trigger) : counts_(static_cast<std::uint32_t>(counts_at_trigger)) {}

  std::uint32_t operator()(Channel channel, std::uint16_t half) {
    switch (channel) {
      case Channel::dac_code:
        return static_cast<std::uint32_t>(static_cast<std::int16_t>(half));
      case Channel::counts:
        return counts_ = nearest(counts_, half);
      case Channel::reference:  // 1/16 counts
        if (!knows_reference_) reference_ = counts_ << 4;
        knows_reference_ = true;
        return (reference_ = nearest(reference_, half)) << 4;
      case Channel::flags:
        return (half & 0xFF7Fu) | (half & 0x80u) << 9;
      default:
        return static_cast<std::uint32_t>(half) << 16;
    }
  }

 private:
  static std::uint32_t nearest(std::uint32_t last, std::uint16_t half) {
    return last + static_cast<std::uint32_t>(static_cast<std::int16_t>(half - static_cast<std::uint16_t>(last)));
  }
  std::uint32_t counts_, reference_ = 0;
  bool knows_reference_ = false;
};

std::vector<std::uint16_t> fetch(BoardClient& board, const firmware::TriggerStatePayload& state) {
  const std::size_t wanted = std::size_t{state.rows} * state.half_words;
  if (state.half_words == 0 || wanted > state.capacity)
    throw Failure(ExitCode::protocol, "the board's capture is impossible");
  std::vector<std::uint16_t> all;
  while (all.size() < wanted) {
    const auto part = board.read_triggered(static_cast<std::uint32_t>(all.size()));
    all.insert(all.end(), part.half_word.begin(), part.half_word.end());
  }
  all.resize(wanted);
  return all;
}

bool is_complete(const firmware::TriggerStatePayload& state) {
  return state.phase == static_cast<std::uint8_t>(TriggerPhase::complete);
}

/// Throws if the board's capture is not the requested one, because another program may have armed it again.
void require_own(const firmware::TriggerStatePayload& state, const firmware::TriggerRequest& asked) {
  const bool is_same = state.channels == asked.channels && state.wide == asked.wide && state.every == asked.every &&
                       state.kind == asked.kind && state.axis == asked.axis;
  const bool fits = !is_complete(state) || (state.trigger_row <= asked.before &&
                                            state.rows == state.trigger_row + asked.after && state.survived == 0);
  if (!is_same || !fits || state.phase == static_cast<std::uint8_t>(TriggerPhase::idle))
    throw Failure(ExitCode::refused,
                  "the board holds another capture than was asked for: another program has armed it");
}

/// Throws if the capture changed while its rows were fetched.
void require_unchanged(BoardClient& board, const firmware::TriggerStatePayload& before) {
  const firmware::TriggerStatePayload now = board.trigger_state();
  if (std::memcmp(&now, &before, sizeof now) != 0)
    throw Failure(ExitCode::refused, "another program armed the board's capture while it was read: read it again");
}

/// Selects the rows of one axis.
Capture capture_of(BoardClient& board, const firmware::TriggerStatePayload& state, const CaptureSettings& settings) {
  const firmware::ParameterValues values = board.read_values();
  const std::int64_t counts = firmware::whole_counts(state.counts_low, state.counts_high);
  ChannelScale scale(values.axis(settings.axis), board.identify().fixed_point != 0, counts);
  const std::vector<std::uint16_t> half = fetch(board, state);
  require_unchanged(board, state);
  // Rows before the trigger are extended backwards from the position at the trigger.
  Widener widen(counts);
  Capture capture;
  capture.row_period_s = static_cast<double>(state.every) / static_cast<double>(values.get<"control.rate">());
  capture.channel.resize(settings.channels.size());
  std::vector<std::vector<std::uint32_t>> words(settings.channels.size(), std::vector<std::uint32_t>(state.rows));
  const auto place_of = [&](Channel channel) {
    return static_cast<std::size_t>(std::ranges::find(settings.channels, channel) - settings.channels.begin());
  };
  const auto widen_row = [&](std::uint32_t row) {
    std::size_t at = std::size_t{row} * state.half_words;
    for (std::size_t axis = 0; axis < hal::kMostAxes; ++axis)
      for (unsigned bit = 0; bit < firmware::kChannels; ++bit) {
        if ((state.channels[axis] >> bit & 1u) == 0) continue;
        const bool is_wide = (state.wide[axis] >> bit & 1u) != 0;
        const auto channel = static_cast<Channel>(bit);
        if (axis == settings.axis)
          words[place_of(channel)][row] =
              is_wide ? half[at] | static_cast<std::uint32_t>(half[at + 1]) << 16 : widen(channel, half[at]);
        at += is_wide ? 2 : 1;
      }
  };
  for (std::uint32_t row = state.trigger_row + 1; row-- > 0;) widen_row(row);
  for (std::uint32_t row = 0; row < state.rows; ++row) widen_row(row);
  for (std::uint32_t row = 0; row < state.rows; ++row) {
    capture.number.push_back(row);
    for (std::size_t i = 0; i < settings.channels.size(); ++i)
      capture.channel[i].push_back(scale(settings.channels[i], words[i][row]));
  }
  capture.trigger_s = state.trigger_row * capture.row_period_s;
  return capture;
}

}  // namespace

bool is_board_trigger(std::string_view text) {
  const std::size_t dot = text.find('.');
  const std::string_view axis = trim_blanks(text.substr(0, dot));
  return dot != std::string_view::npos &&
         (axis == "any" || std::ranges::find(firmware::kAxisNames, axis) != firmware::kAxisNames.end());
}

BoardTrigger parse_board_trigger(std::string_view text, sim::DriveKind kind) {
  BoardTrigger trigger;
  const std::size_t dot = text.find('.');
  const std::string_view axis = trim_blanks(text.substr(0, dot));
  const auto found = std::ranges::find(firmware::kAxisNames, axis);
  trigger.axis = found == firmware::kAxisNames.end() ? firmware::kAnyAxis
                                                     : static_cast<std::uint8_t>(found - firmware::kAxisNames.begin());
  const std::string_view event = text.substr(dot + 1);
  const std::size_t sign = event.find_first_of("<>");
  const std::string_view name = trim_blanks(event.substr(0, sign));
  if (sign != std::string_view::npos) {
    trigger.kind = TriggerKind::edge;
    trigger.channel = channel_called(name, kind);
    trigger.falling = event[sign] == '<';
    trigger.level = level_of(event.substr(sign + 1), kind,
                             trigger.channel == Channel::flags || name == channel_name(trigger.channel, kind));
  } else if (name == "fault") {
    trigger.kind = TriggerKind::fault;
  } else if (name == "motion") {
    trigger.kind = TriggerKind::motion;
  } else if (name != "now") {
    throw Failure(ExitCode::usage,
                  fmt::format("{}: write for example 'x.position_error > 20um', 'x.fault', 'x.motion', "
                              "'x.now'",
                              text));
  }
  if (trigger.axis == firmware::kAnyAxis && trigger.kind != TriggerKind::fault)
    throw Failure(ExitCode::usage, fmt::format("{}: 'any' is possible only for a fault; name an axis", text));
  return trigger;
}

Capture run_triggered_capture(BoardClient& board, const TriggeredSettings& settings,
                              const std::function<bool()>& stop) {
  const CaptureSettings& wanted = settings.capture;
  const firmware::ParameterValues values = board.read_values();
  const bool fixed_point = board.identify().fixed_point != 0;
  const double row_period_s = wanted.every / static_cast<double>(values.get<"control.rate">());
  firmware::TriggerRequest request{};
  std::size_t half_words = 0;
  for (const Channel channel : wanted.channels) {
    const auto mask = static_cast<std::uint16_t>(1u << static_cast<unsigned>(channel));
    const bool is_wide = !firmware::is_whole(channel) && (settings.wide || fixed_point);
    request.channels[wanted.axis] |= mask;
    if (is_wide) request.wide[wanted.axis] |= mask;
    half_words += is_wide ? 2 : 1;
  }
  const double before = std::round(wanted.before_s / row_period_s),
               after = std::ceil(wanted.duration_s / row_period_s - 1e-9);
  const double room = std::floor(static_cast<double>(board.trigger_state().capacity) / static_cast<double>(half_words));
  if (before + after > room || after < 1.0)
    throw Failure(
        ExitCode::usage,
        fmt::format("{:g} s before and {:g} s after the trigger are {:g} rows, and the board holds {:g}: {:g} s "
                    "with these channels; choose fewer of them, or --every",
                    wanted.before_s, wanted.duration_s, before + after, room, room * row_period_s));
  request.every = wanted.every;
  request.kind = static_cast<std::uint8_t>(settings.trigger.kind);
  request.axis = settings.trigger.axis;
  request.channel = static_cast<std::uint8_t>(settings.trigger.channel);
  request.falling = settings.trigger.falling ? 1 : 0;
  if (settings.trigger.kind == TriggerKind::edge)
    request.level = level_word(settings.trigger, values.axis(settings.trigger.axis), fixed_point);
  request.before = static_cast<std::uint32_t>(before);
  request.after = static_cast<std::uint32_t>(after);
  board.arm_trigger(request);
  const auto began = board.now();
  for (;;) {
    const firmware::TriggerStatePayload state = board.trigger_state();
    require_own(state, request);
    if (is_complete(state)) {
      Capture capture = capture_of(board, state, wanted);
      board.arm_trigger({});  // disarms the board, so that its capture can be read again
      return capture;
    }
    const bool is_waiting = state.phase == static_cast<std::uint8_t>(TriggerPhase::waiting);
    const std::chrono::duration<double> waited = board.now() - began;
    if (stop() || (is_waiting && waited.count() > wanted.patience_s)) {
      board.arm_trigger({});
      throw Failure(stop() ? ExitCode::refused : ExitCode::time_out,
                    stop() ? "interrupted" : fmt::format("the trigger did not come within {:g} s", wanted.patience_s));
    }
    board.wait(std::chrono::milliseconds(20));
  }
}

Capture read_triggered_capture(BoardClient& board, TriggeredSettings& settings) {
  const firmware::TriggerStatePayload state = board.trigger_state();
  CaptureSettings& taken = settings.capture;
  if (!is_complete(state) || state.channels.at(taken.axis) == 0)
    throw Failure(ExitCode::refused, fmt::format("the board holds no capture of axis {}: arm one with --trigger",
                                                 firmware::kAxisNames.at(taken.axis)));
  taken.channels.clear();
  for (unsigned bit = 0; bit < firmware::kChannels; ++bit)
    if ((state.channels[taken.axis] >> bit & 1u) != 0) taken.channels.push_back(static_cast<Channel>(bit));
  taken.every = state.every;
  return capture_of(board, state, taken);
}

}  // namespace host
