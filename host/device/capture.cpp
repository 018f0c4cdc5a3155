#include "host/device/capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>

#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/record/columns.hpp"

namespace host {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

class CaptureRun {
 public:
  CaptureRun(BoardClient& board, const CaptureSettings& settings)
      : board_(board),
        settings_(settings),
        values_(board.read_values()),
        scale_(values_.axis(settings.axis), board.identify().fixed_point != 0,
               board.status().axis.at(settings.axis).counts(), settings.table_resolution) {
    capture_.row_period_s = static_cast<double>(settings.every) / values_.get<"control.rate">();
    capture_.channel.resize(settings.channels.size());
    wanted_ = static_cast<std::size_t>(std::ceil(total_duration() / capture_.row_period_s - 1e-9));
    before_ = settings.trigger ? static_cast<std::size_t>(std::llround(settings.before_s / capture_.row_period_s)) : 0;
    triggered_ = !settings.trigger;
    for (std::size_t i = 0; settings.trigger && i < settings.channels.size(); ++i)
      if (settings.channels[i] == settings.trigger->channel) trigger_column_ = i;
  }

  Capture run(const CaptureWatch& watch) {
    firmware::CaptureRequest request;
    for (const firmware::Channel channel : settings_.channels)
      request.channels[settings_.axis] |= static_cast<std::uint16_t>(1u << static_cast<unsigned>(channel));
    request.every = settings_.every;
    board_.take_capture(request);
    try {
      fetch(watch);
    } catch (...) {
      end_quietly();
      throw;
    }
    if (!settings_.jogs.empty()) board_.stop();
    capture_.dropped_by_board = board_.stop_capture().dropped;
    capture_.lost = lost_rows(capture_.number);
    return std::move(capture_);
  }

 private:
  double total_duration() const {
    if (settings_.duration_s > 0.0) return settings_.duration_s;
    double sum = 0.0;
    for (const JogStep& step : settings_.jogs) sum += step.duration_s;
    return sum;
  }

  void fetch(const CaptureWatch& watch) {
    const auto began = board_.now();
    auto heard = began;
    next_jog_ = began;
    while (after_ < wanted_) {
      const auto samples = board_.next_samples(milliseconds(10));
      if (samples) take(*samples);
      const auto now = board_.now();
      if (samples) last_row_ = now;
      steer(now);
      if (now - heard > kHeartbeat) {
        settings_.jogs.empty() ? board_.heartbeat() : examine();  // keeps the capture alive
        heard = now;
      }
      if (!triggered_ && now - began > std::chrono::duration<double>(settings_.patience_s))
        throw Failure(ExitCode::time_out, fmt::format("the trigger did not come within {:g} s", settings_.patience_s));
      const double silence_s =
          2.0 + std::chrono::duration<double>(board_.patience()).count() + 20.0 * capture_.row_period_s;
      if (now - std::max(last_row_, began) > std::chrono::duration<double>(silence_s))
        throw Failure(ExitCode::time_out, "the board sends no more samples" + board_.other_users());
      if (!watch || watch(capture_)) continue;
      if (!triggered_ || capture_.number.empty())
        throw Failure(ExitCode::refused, triggered_ ? "ended before a row came" : "ended before the trigger came");
      return;
    }
  }

  /// Commands the jogs one after the other, timed by the computer's clock.
  void steer(steady_clock::time_point now) {
    if (jog_ > settings_.jogs.size() || settings_.jogs.empty() || now < next_jog_) return;
    if (jog_ == settings_.jogs.size()) {
      board_.stop();
    } else {
      board_.jog(settings_.axis, settings_.jogs[jog_].velocity);
      next_jog_ += std::chrono::duration_cast<steady_clock::duration>(
          std::chrono::duration<double>(settings_.jogs[jog_].duration_s));
    }
    ++jog_;
  }

  /// A heartbeat that also tells whether the axis still runs.
  void examine() {
    if (board_.status().axis.at(settings_.axis).fault != 0)
      throw Failure(ExitCode::device_fault, "the axis stopped with a fault: `axistool faults` shows cause and remedy");
  }

  void take(const BoardClient::Samples& samples) {
    const std::size_t rows = rows_in(samples, settings_.channels.size());
    for (std::size_t row = 0; row < rows && after_ < wanted_; ++row)
      take_row(samples.first_row + static_cast<std::uint32_t>(row),
               samples.words.data() + row * settings_.channels.size());
  }

  void take_row(std::uint32_t number, const std::uint32_t* words) {
    append_row(capture_, settings_.channels, scale_, number, words);
    if (!triggered_) {
      const double value = capture_.channel[trigger_column_].back();
      const bool beyond =
          settings_.trigger->rising ? value > settings_.trigger->level : value < settings_.trigger->level;
      triggered_ = beyond && was_short_;
      was_short_ = was_short_ || !beyond;
      // While waiting for the trigger only every 1000 rows, because erasing at the front moves all other rows.
      if (triggered_ || capture_.number.size() > before_ + 1000) keep_last(before_ + 1);
      if (triggered_) capture_.trigger_s = (number - capture_.number.front()) * capture_.row_period_s;
    }
    if (triggered_) ++after_;
  }

  void keep_last(std::size_t rows) {
    const auto cut = [&](auto& column) {
      if (column.size() > rows) column.erase(column.begin(), column.end() - static_cast<std::ptrdiff_t>(rows));
    };
    cut(capture_.number);
    for (auto& column : capture_.channel) cut(column);
  }

  void end_quietly() {
    try {
      if (!settings_.jogs.empty()) board_.stop();
      board_.stop_capture();
    } catch (const Failure&) {  // the board is gone; the first failure is reported
    }
  }

  BoardClient& board_;
  const CaptureSettings& settings_;
  firmware::ParameterValues values_;
  ChannelScale scale_;
  Capture capture_;
  std::size_t wanted_ = 0, before_ = 0, after_ = 0;
  std::size_t trigger_column_ = 0;
  bool triggered_ = false;
  bool was_short_ = false;  ///< an earlier row was on the other side of the level, as a crossing requires
  std::size_t jog_ = 0;
  steady_clock::time_point next_jog_;
  steady_clock::time_point last_row_;
};

}  // namespace

Trigger parse_trigger(std::string_view text, sim::DriveKind kind) {
  const std::size_t sign = text.find_first_of("<>");
  const std::string level(sign == std::string_view::npos ? "" : text.substr(sign + 1));
  char* end = nullptr;
  const double value = std::strtod(level.c_str(), &end);
  if (level.empty() || *end != '\0')
    throw Failure(ExitCode::usage, fmt::format("{}: write CHANNEL>LEVEL or CHANNEL<LEVEL, for example '{}>5'", text,
                                               channel_name(firmware::Channel::tachometer_velocity, kind)));
  return {channel_named(text.substr(0, sign), kind), text[sign] == '>', value};
}

JogStep parse_jog(const std::string& text) {
  JogStep step;
  const char* next = text.c_str();
  char* end = nullptr;
  step.velocity = std::strtod(next, &end);
  const bool has_speed = end != next && *end == ':';
  next = has_speed ? end + 1 : next;
  step.duration_s = std::strtod(next, &end);
  if (!has_speed || end == next || *end != '\0' || !std::isfinite(step.velocity) || !(step.duration_s > 0.0))
    throw Failure(ExitCode::usage, fmt::format("--jog {}: write SPEED:SECONDS, for example 20:1.5", text));
  return step;
}

void require_capturable(const firmware::ParameterValues& values, const CaptureSettings& settings) {
  for (const JogStep& jog : settings.jogs) require_reachable(values, settings.axis, jog.velocity);
  const double rate_Hz = static_cast<double>(values.get<"control.rate">()) / settings.every;
  const double reports_Hz = rate_Hz / std::floor(static_cast<double>(firmware::kWordsPerReport) /
                                                 static_cast<double>(settings.channels.size()));
  if (reports_Hz > 1000.0)
    throw Failure(ExitCode::usage, fmt::format("{} channels at {:g} Hz need {:.0f} reports per second, but USB carries "
                                               "1000: give fewer channels, or --every {}",
                                               settings.channels.size(), rate_Hz, reports_Hz,
                                               settings.every * static_cast<unsigned>(std::ceil(reports_Hz / 1000.0))));
}

void require_no_loss(const Capture& capture, const std::string& where) {
  if (capture.lost > 0)
    throw Failure(ExitCode::protocol,
                  fmt::format("{} rows were lost ({} dropped by the board); {} has gaps there, nothing is filled in: "
                              "capture fewer channels or a lower rate, and close programs that load the computer",
                              capture.lost, capture.dropped_by_board, where));
}

std::size_t rows_in(const BoardClient::Samples& samples, std::size_t channels) {
  if (samples.words.size() % channels != 0)
    throw Failure(ExitCode::protocol, "the board sends rows of another length than requested");
  return samples.words.size() / channels;
}

void append_row(Capture& capture, const std::vector<firmware::Channel>& channels, ChannelScale& scale,
                std::uint32_t number, const std::uint32_t* words) {
  capture.number.push_back(number);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto place = std::ranges::count_if(channels, [&](firmware::Channel other) { return other < channels[i]; });
    capture.channel[i].push_back(scale(channels[i], words[place]));
  }
}

std::size_t lost_rows(const std::vector<std::uint32_t>& numbers) {
  std::size_t lost = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) lost += numbers[i] - numbers[i - 1] - 1;
  return lost;
}

Capture run_capture(BoardClient& board, const CaptureSettings& settings, const CaptureWatch& watch) {
  return CaptureRun(board, settings).run(watch);
}

Record capture_record(const Capture& capture, const CaptureSettings& settings, const std::string& drive) {
  Record record;
  record.drive = drive;
  record.kind = settings.kind;
  record.sample_period_s = capture.row_period_s;
  record.header["source"] = "axistool capture";
  if (capture.trigger_s) record.header["trigger_s"] = fmt::format("{}", *capture.trigger_s);
  if (capture.lost > 0) record.header["lost_rows"] = std::to_string(capture.lost);
  const auto periods_a_second = static_cast<double>(std::llround(1.0 / capture.row_period_s));
  const bool is_whole_rate = std::abs(periods_a_second * capture.row_period_s - 1.0) < 1e-12;
  for (const std::uint32_t number : capture.number) {
    const double rows = number - capture.number.front();  // division gives 0.003, not 0.0030000000000000001
    record.t_s.push_back(is_whole_rate ? rows / periods_a_second : rows * capture.row_period_s);
  }
  for (std::size_t i = 0; i < settings.channels.size(); ++i) {
    const std::string name = channel_name(settings.channels[i], settings.kind);
    if (const KnownColumn* known = find_known_column(name))
      record.*(known->channel) = capture.channel[i];
    else
      record.extra.push_back({name, capture.channel[i], {}});
  }
  return record;
}

}  // namespace host
