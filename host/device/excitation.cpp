#include "host/device/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/excitation/excitation_run.hpp"
#include "host/device/closed_loops.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using firmware::Channel;
using firmware::ExcitationEnd;
using firmware::ExcitationPhase;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr double kRest_s = 0.2;

/// Collects the rows of a capture as they arrive, in the order of the channels.
class Rows {
 public:
  Rows(BoardClient& board, const CaptureSettings& settings, ChannelScale scale, Capture& capture)
      : board_(board), settings_(settings), scale_(std::move(scale)), capture_(capture) {
    capture_.channel.resize(settings.channels.size());
  }

  bool fetch(milliseconds patience) {
    const auto samples = board_.next_samples(patience);
    if (!samples) return false;
    const std::size_t channels = settings_.channels.size(), rows = rows_in(*samples, channels);
    for (std::size_t row = 0; row < rows; ++row)
      append_row(capture_, settings_.channels, scale_, samples->first_row + static_cast<std::uint32_t>(row),
                 samples->words.data() + row * channels);
    return true;
  }

 private:
  BoardClient& board_;
  const CaptureSettings& settings_;
  ChannelScale scale_;
  Capture& capture_;
};

}  // namespace

ExcitationScale excitation_scale(const firmware::ParameterValues& values, std::uint8_t axis, sim::DriveKind kind) {
  const firmware::AxisValues v = values.axis(axis);
  ExcitationScale scale;
  scale.kind = kind;
  scale.encoder_resolution = static_cast<double>(v.get<"drive.encoder_resolution">());
  scale.dac_resolution_V = static_cast<double>(v.get<"drive.dac_resolution">());
  scale.rate_Hz = static_cast<double>(values.get<"control.rate">());
  scale.has_tachometer = v.get<"tachometer.fitted">();
  if (v.get<"drive.fitted">()) {
    scale.lead = static_cast<double>(v.get<"drive.lead">());
    scale.acceleration = static_cast<double>(v.get<"limits.acceleration">());
    scale.jerk = static_cast<double>(v.get<"limits.jerk">());
  }
  return scale;
}

std::vector<firmware::ExcitationEntriesRequest> entry_requests(const Excitation& excitation, std::uint8_t axis) {
  std::vector<firmware::ExcitationEntriesRequest> parts;
  for (std::size_t i = 0; i < excitation.entries.size(); i += parts.back().count) {
    firmware::ExcitationEntriesRequest part;
    part.axis = axis;
    part.input = excitation.request.input;
    part.first = static_cast<std::uint8_t>(i);
    part.count = static_cast<std::uint8_t>(std::min(firmware::kEntriesPerReport, excitation.entries.size() - i));
    for (std::size_t k = 0; k < part.count; ++k) part.entry[k] = excitation.entries[i + k];
    parts.push_back(part);
  }
  return parts;
}

std::string_view end_name(firmware::ExcitationStatePayload state) {
  switch (static_cast<ExcitationEnd>(state.end)) {
    case ExcitationEnd::none:
      return "not ended";
    case ExcitationEnd::completed:
      return "completed";
    case ExcitationEnd::asked:
      return "stopped";
    case ExcitationEnd::travel:
      return "left the box: travel";
    case ExcitationEnd::speed:
      return "left the box: speed";
    case ExcitationEnd::no_motion:
      return "no motion";
    case ExcitationEnd::fault:
      return "fault";
    case ExcitationEnd::refused:
      return "not enabled";
    case ExcitationEnd::blind:
      return "encoder and tachometer show different motion";
  }
  return "unknown";
}

namespace {

bool is_open_loop(const Excitation& excitation) {
  return excitation.request.input == static_cast<std::uint8_t>(firmware::ExcitationInput::open_loop);
}

}  // namespace

ExcitationOutcome run_excitation(BoardClient& board, std::uint8_t axis, const Excitation& excitation,
                                 const firmware::ParameterValues& values, const ExcitationScale& scale,
                                 const std::function<bool()>& stop, const std::function<void(std::size_t)>& progress) {
  return run_excitations(
      board, axis, 1, [&](std::size_t, double) { return excitation; }, values, scale, stop, progress);
}

ExcitationOutcome run_excitations(BoardClient& board, std::uint8_t axis, std::size_t count,
                                  const std::function<Excitation(std::size_t, double)>& make,
                                  const firmware::ParameterValues& values, const ExcitationScale& scale,
                                  const std::function<bool()>& stop, const std::function<void(std::size_t)>& progress) {
  ExcitationOutcome outcome;
  outcome.settings.axis = axis;
  outcome.settings.kind = scale.kind;
  outcome.settings.channels = usual_channels(scale.has_tachometer);
  if (count > 1 || is_open_loop(make(0, 0.0)))
    outcome.settings.channels.resize(scale.has_tachometer ? 3 : 2);  // the reference is missing in some or all rows
  const firmware::AxisStatus status = board.status().axis.at(axis);
  if (scale.table_resolution > 0.0 && (status.flags & firmware::kAxisScale) != 0)
    outcome.settings.channels.push_back(Channel::table_counts);
  outcome.capture.row_period_s = 1.0 / scale.rate_Hz;
  const std::int64_t start = status.counts();
  Rows rows(board, outcome.settings,
            ChannelScale(values.axis(axis), board.identify().fixed_point != 0, start, scale.table_resolution),
            outcome.capture);
  firmware::CaptureRequest capture;
  for (const Channel channel : outcome.settings.channels)
    capture.channels[axis] |= static_cast<std::uint16_t>(1u << static_cast<unsigned>(channel));
  const auto is_over = [](const firmware::ExcitationStatePayload& state) {
    return state.phase == static_cast<std::uint8_t>(ExcitationPhase::done);
  };
  bool is_capturing = false;
  std::optional<ClosedLoops> loop;  // outlives the handler below, so that the loop opens after the excitation stopped
  const auto run_one = [&](std::size_t index) {
    const std::int64_t offset = board.status().axis.at(axis).counts() - start;
    const Excitation excitation = make(index, static_cast<double>(offset) * scale.encoder_resolution);
    if (!is_open_loop(excitation)) loop.emplace(board, static_cast<std::uint8_t>(1u << axis));
    for (const auto& part : entry_requests(excitation, axis)) board.load_excitation(part);
    firmware::ExcitationRequest request = excitation.request;
    request.axis = axis;
    if (!is_capturing) board.take_capture(capture);
    is_capturing = true;  // from here on this program must stop the capture
    board.start_excitation(request);
    firmware::ExcitationStatePayload state;
    bool is_asked = false;
    for (auto heard = steady_clock::time_point{}; !is_over(state);) {
      const bool came = rows.fetch(milliseconds(10));
      if (progress) progress(outcome.capture.number.size());
      const auto now = board.now();
      if (came && now - heard < kHeartbeat) continue;
      heard = now;
      state = board.excitation_state();
      if (stop() && !is_asked) {
        board.stop_excitation();
        is_asked = true;
      }
    }
    if (loop) loop->open();
    loop.reset();
    state.elapsed += outcome.state.elapsed;
    state.farthest = std::max(outcome.state.farthest, static_cast<std::int32_t>(std::abs(offset)) + state.farthest);
    state.fastest = std::max(outcome.state.fastest, state.fastest);
    outcome.state = state;
    return state.end == static_cast<std::uint8_t>(ExcitationEnd::completed) && !stop();
  };
  // The board reports an axis as standing only some time after it has stopped.
  const auto rest = [&] {
    const std::size_t wanted = outcome.capture.number.size() + static_cast<std::size_t>(kRest_s * scale.rate_Hz);
    while (outcome.capture.number.size() < wanted && rows.fetch(milliseconds(500))) continue;
  };
  try {
    for (std::size_t index = 0; index < count && run_one(index);)
      if (++index < count) rest();
    outcome.capture.dropped_by_board = board.stop_capture().dropped;
    while (rows.fetch(milliseconds(50))) continue;
    outcome.capture.lost = lost_rows(outcome.capture.number);
  } catch (...) {  // of the board, or of progress()
    try {
      board.stop_excitation();
      if (is_capturing) board.stop_capture();
    } catch (const Failure&) {  // the board is gone; the first failure is reported
    }
    throw;
  }
  return outcome;
}

}  // namespace host
