#include "host/live/board_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "host/device/capture_wish.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPump{20}, kStatusInterval{100}, kRetry{1000}, kValuesInterval{2000}, kLongestEnd{3000};
constexpr double kMostRows_Hz = 1000.0;

/// Whether rows before and after a change have the same units and spacing.
bool is_same_scale(const firmware::ParameterValues& a, const firmware::ParameterValues& b) {
  const auto scale_of = [](const firmware::AxisValues& axis) {
    return std::tuple(axis.get<"drive.fitted">(), axis.get<"drive.lead">(), axis.get<"drive.encoder_resolution">(),
                      axis.get<"drive.dac_resolution">());
  };
  if (a.axes() != b.axes() || a.get<"control.rate">() != b.get<"control.rate">()) return false;
  for (std::size_t axis = 0; axis < a.axes(); ++axis)
    if (scale_of(a.axis(axis)) != scale_of(b.axis(axis))) return false;
  return true;
}

}  // namespace

BoardWatch::BoardWatch(OpenBoard open) : open_(std::move(open)) {
  connect();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

BoardWatch::~BoardWatch() = default;

BoardPicture BoardWatch::picture() const {
  const std::lock_guard lock(mutex_);
  BoardPicture picture = picture_;
  if (ring_) {
    picture.begin = ring_->begin();
    picture.end = ring_->end();
    picture.lost = ring_->lost();
    picture.repeated = ring_->repeated();
  }
  return picture;
}

void BoardWatch::choose(std::vector<WatchedChannel> channels) {
  const std::lock_guard lock(mutex_);
  wanted_ = std::move(channels);
}

void BoardWatch::lend(const std::string& to) {
  {
    const std::lock_guard lock(mutex_);
    if (picture_.trigger.phase == WatchedTrigger::Phase::waiting)
      throw Failure(ExitCode::refused, "a trigger waits: disarm it first");
    is_lent_ = true;
    picture_.message = to;
  }
  for (const auto until = steady_clock::now() + kLongestEnd; steady_clock::now() < until;) {
    {
      const std::lock_guard lock(mutex_);
      if (!is_streaming_) return;
    }
    std::this_thread::sleep_for(kPump);
  }
  give_back();
  throw Failure(ExitCode::time_out, "the stream of the board's channels does not end");
}

void BoardWatch::give_back() {
  const std::lock_guard lock(mutex_);
  is_lent_ = false;
}

void BoardWatch::look_again() {
  const std::lock_guard lock(mutex_);
  next_values_ = {};
}

std::optional<Envelope> BoardWatch::envelope(std::uint64_t epoch, std::uint64_t from, std::uint64_t to,
                                             std::size_t rows) const {
  const std::lock_guard lock(mutex_);
  if (epoch != picture_.epoch || !ring_) return std::nullopt;
  return ring_->envelope(from, to, rows);
}

Capture BoardWatch::rows(std::uint64_t epoch, std::uint8_t axis, std::uint64_t from, std::uint64_t to,
                         CaptureSettings& settings) const {
  const std::lock_guard lock(mutex_);
  if (epoch != picture_.epoch || !ring_)
    throw Failure(ExitCode::refused, "these rows are no longer kept: another stream has begun");
  settings.axis = axis;
  settings.kind = picture_.kinds.at(axis);
  settings.channels.clear();
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < picture_.channels.size(); ++k)
    if (picture_.channels[k].axis == axis) {
      settings.channels.push_back(picture_.channels[k].channel);
      columns.push_back(k);
    }
  Capture capture;
  capture.row_period_s = picture_.row_period_s;
  capture.channel.resize(columns.size());
  ring_->each(from, to, [&](std::uint64_t number, std::span<const double> values) {
    capture.number.push_back(static_cast<std::uint32_t>(number));
    for (std::size_t k = 0; k < columns.size(); ++k) capture.channel[k].push_back(values[columns[k]]);
  });
  if (columns.empty() || capture.number.empty())
    throw Failure(ExitCode::refused, "none of these rows is kept, or none of their channels belongs to the axis");
  capture.lost = lost_rows(capture.number);
  return capture;
}

void BoardWatch::arm(TriggeredSettings settings, KeepCapture keep) {
  const std::lock_guard lock(mutex_);
  if (picture_.trigger.phase == WatchedTrigger::Phase::waiting)
    throw Failure(ExitCode::refused, "the trigger is armed already");
  if (is_lent_) throw Failure(ExitCode::refused, picture_.message);
  if (!picture_.is_connected) throw Failure(ExitCode::no_such_device, picture_.message);
  picture_.trigger = {WatchedTrigger::Phase::waiting, ""};
  is_disarmed_ = false;
  armed_.emplace(Armed{std::move(settings), std::move(keep)});
}

void BoardWatch::disarm() {
  const std::lock_guard lock(mutex_);
  is_disarmed_ = true;
}

void BoardWatch::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    milliseconds pause = kPump;
    try {
      if (!board_) connect();
      step(stop);
    } catch (const Failure& failure) {
      lose(failure.what());
      pause = kRetry;
    }
    std::unique_lock lock(mutex_);
    ending_.wait_for(lock, stop, pause, [] { return false; });
  }
  try {
    if (board_ && is_streaming_) board_->stop_capture();
  } catch (const Failure&) {  // the board has gone
  }
}

void BoardWatch::connect() {
  board_.emplace(open_());
  board_->require_same_table();
  fixed_point_ = board_->identify().fixed_point != 0;
  {
    const std::lock_guard lock(mutex_);
    picture_.name = board_->name();
  }
  read_values();
  poll_status();
  start_stream();
  const std::lock_guard lock(mutex_);
  picture_.is_connected = true;
}

void BoardWatch::lose(const std::string& message) {
  board_.reset();
  const std::lock_guard lock(mutex_);
  picture_.is_connected = false;
  picture_.message = message;
  is_streaming_ = false;
  if (picture_.trigger.phase == WatchedTrigger::Phase::waiting) {
    picture_.trigger = {WatchedTrigger::Phase::failed, message};
    armed_.reset();
  }
}

void BoardWatch::step(const std::stop_token& stop) {
  std::optional<Armed> armed;
  bool reads = false, starts = false, ends = false;
  const auto now = steady_clock::now();
  const bool is_wished = now >= next_status_ && is_capture_wished(board_->name());
  {
    const std::lock_guard lock(mutex_);
    armed.swap(armed_);
    reads = now >= next_values_;
    ends = (is_lent_ || is_wished) && is_streaming_;
    starts = !ends && (wanted_.has_value() || (!is_streaming_ && now >= next_stream_));
  }
  if (ends) end_stream();  // the next one begins after kRetry, if no other program captures
  if (reads) read_values();
  if (starts) start_stream();
  if (armed) run_armed(stop, std::move(*armed));
  fetch();
  if (now >= next_status_) poll_status();
}

void BoardWatch::read_values() {
  firmware::ParameterValues values = board_->read_values();
  const std::lock_guard lock(mutex_);
  if (!is_same_scale(values, picture_.values)) is_streaming_ = false;
  picture_.kinds = kinds_of(values);
  picture_.values = std::move(values);
  next_values_ = steady_clock::now() + kValuesInterval;
}

void BoardWatch::start_stream() {
  std::vector<WatchedChannel> channels;
  {
    const std::lock_guard lock(mutex_);
    if (is_lent_) return;
    const bool had_axis = std::ranges::any_of(picture_.channels, [&](const WatchedChannel& one) {
      return picture_.values.axis(one.axis).get<"drive.fitted">();
    });
    if (!wanted_ && !picture_.channels.empty() && had_axis) wanted_ = picture_.channels;
    channels = wanted_.value_or(usual_watch(picture_.values));
    wanted_.reset();
  }
  firmware::CaptureRequest request;
  for (const WatchedChannel& one : channels)
    request.channels.at(one.axis) |= static_cast<std::uint16_t>(1u << static_cast<unsigned>(one.channel));
  const double rate_Hz = picture_.values.get<"control.rate">();
  request.every = static_cast<std::uint16_t>(std::max(1.0, std::ceil(rate_Hz / kMostRows_Hz)));
  std::string refusal;
  try {
    if (picture_.epoch > 0 && (board_->status().flags & firmware::kBoardCapturing) != 0) board_->stop_capture();
    board_->start_capture(request);
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::refused) throw;
    refusal = failure.what();
  }
  const BoardState status = board_->status();
  scales_.clear();
  for (std::size_t axis = 0; axis < status.axis.size(); ++axis)
    scales_.emplace_back(picture_.values.axis(axis), fixed_point_, status.axis[axis].counts());
  const std::lock_guard lock(mutex_);
  next_stream_ = steady_clock::now() + kRetry;
  picture_.message = refusal;
  is_streaming_ = refusal.empty();
  if (!is_streaming_) return;
  picture_.channels = channels;
  picture_.row_period_s = request.every / rate_Hz;
  ++picture_.epoch;
  ring_ = std::make_unique<SampleRing>(channels.size());
}

void BoardWatch::end_stream() {
  board_->stop_capture();
  const std::lock_guard lock(mutex_);
  is_streaming_ = false;
  next_stream_ = steady_clock::now() + kRetry;
}

void BoardWatch::fetch() {
  while (const auto samples = board_->next_samples(milliseconds(0))) take(*samples);
}

void BoardWatch::take(const BoardClient::Samples& samples) {
  std::array<double, firmware::kWordsPerReport> values{};
  const std::lock_guard lock(mutex_);
  if (!is_streaming_) return;
  const std::size_t channels = picture_.channels.size(), rows = rows_in(samples, channels);
  const std::uint32_t* word = samples.words.data();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < channels; ++k)
      values[k] = scales_.at(picture_.channels[k].axis)(picture_.channels[k].channel, *word++);
    ring_->append(samples.first_row + static_cast<std::uint32_t>(row), {values.data(), channels});
  }
}

void BoardWatch::poll_status() {
  next_status_ = steady_clock::now() + kStatusInterval;
  BoardState status = board_->status();
  const std::lock_guard lock(mutex_);
  // Another program may have ended the stream.
  if ((status.flags & firmware::kBoardCapturing) == 0) is_streaming_ = false;
  for (std::size_t axis = 0; axis < std::min(status.axis.size(), picture_.status.axis.size()); ++axis)
    if (((status.axis[axis].flags ^ picture_.status.axis[axis].flags) & firmware::kAxisFitted) != 0) next_values_ = {};
  picture_.status = std::move(status);
}

void BoardWatch::run_armed(const std::stop_token& stop, Armed armed) {
  WatchedTrigger result{WatchedTrigger::Phase::done, ""};
  const auto is_ended = [&] {
    fetch();
    if (steady_clock::now() >= next_status_) poll_status();
    const std::lock_guard lock(mutex_);
    return is_disarmed_ || stop.stop_requested();
  };
  try {
    const Capture capture = run_triggered_capture(*board_, armed.settings, is_ended);
    result.text = armed.keep(capture, armed.settings.capture);
  } catch (const Failure& failure) {
    if (failure.code == ExitCode::no_such_device) throw;
    result = {WatchedTrigger::Phase::failed, failure.what()};
  }
  const std::lock_guard lock(mutex_);
  if (is_disarmed_) result = {};
  picture_.trigger = std::move(result);
}

}  // namespace host
