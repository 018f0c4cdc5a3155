#include "host/device/path_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "firmware/core/path/path_follower.hpp"
#include "host/device/capture.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using firmware::Channel;
using firmware::PathPhase;
using firmware::PathStatePayload;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kRound{10};    // a tenth of the board's heartbeat time-out while it moves
constexpr int kReportsARound = 4;     // reports of rows, which arrive continuously; each takes at most 2 ms
constexpr double kHeadStart_s = 0.5;  // duration of the nodes sent before the board starts
// USB carries this many reports of rows a second besides the nodes.
constexpr double kMostReports_Hz = 500.0;
constexpr std::size_t kMostRowsAReport = 2;
constexpr std::size_t kAxisWords = 2, kForceWords = 3;

firmware::OpenPathRequest open_request(const PathScale& scale, const firmware::PathUnits& units, bool relative,
                                       firmware::ProbeStop probe = firmware::ProbeStop::none) {
  firmware::OpenPathRequest request;
  request.probe = probe;
  for (const std::size_t axis : scale.axes) request.mask |= static_cast<std::uint8_t>(1u << axis);
  request.relative = relative ? 1 : 0;
  request.units = units;
  return request;
}

std::vector<BoardPosition> positions(const firmware::OpenPathPayload& opened, const PathScale& scale) {
  std::vector<BoardPosition> at;
  for (const std::size_t axis : scale.axes) {
    const auto& one = opened.axis.at(axis);
    at.push_back({firmware::whole_counts(one.counts_low, one.counts_high), std::ldexp(one.fraction, -32)});
  }
  return at;
}

/// The node for the board, with its axes in the order of their numbers.
std::vector<std::byte> bytes_of(const PathWord& node, bool is_last, const PathScale& scale) {
  std::vector<std::uint32_t> words{node.time() | (is_last ? firmware::kLastNode : 0u)};
  std::vector<std::size_t> order(scale.axes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return scale.axes[i]; });
  for (const std::size_t i : order)
    for (const std::int32_t word : {node.axis[i].travel, node.axis[i].velocity, node.axis[i].acceleration})
      words.push_back(static_cast<std::uint32_t>(word));
  std::vector<std::byte> bytes(4 * words.size());
  std::memcpy(bytes.data(), words.data(), bytes.size());
  return bytes;
}

/// Sends nodes while the board has room, and reads the board's progress.
class Stream {
 public:
  Stream(BoardClient& board, const PathWords& words, const PathScale& scale, const std::vector<PathStop>& stops)
      : board_(board), words_(words), scale_(scale), stops_(stops) {}

  /// Whether all nodes up to the next stop are sent; those after it are sent when the operator continues the program.
  bool is_all_sent() const { return next_ == (passed_ < stops_.size() ? stops_[passed_].knot : words_.nodes.size()); }
  /// The stop that the axes have reached.
  const PathStop* waits() const {
    const bool is_there = is_all_sent() && next_ < words_.nodes.size() && passed_ < stops_.size() &&
                          state_.passed_nodes >= next_ && state_.ahead == 0;
    return is_there ? &stops_[passed_] : nullptr;
  }
  void resume() { ++passed_; }
  double sent_s() const { return static_cast<double>(sent_) / (1u << firmware::kPathTimeBits) / scale_.rate_Hz; }
  const PathStatePayload& state() const { return state_; }
  void ask() { state_ = board_.path_state(); }
  void set(const PathStatePayload& state) { state_ = state; }

  /// Sends one node; false if there is none to send, or no room on the board.
  bool send() {
    if (is_all_sent()) return false;
    const PathWord& node = words_.nodes[next_];
    try {
      if (!board_.path_nodes(bytes_of(node, next_ + 1 == words_.nodes.size(), scale_), state_)) return false;
    } catch (const Failure& failure) {
      // A stopping path accepts no more nodes.
      state_ = board_.path_state();
      if (static_cast<PathPhase>(state_.phase) >= PathPhase::stopping) {
        next_ = words_.nodes.size();
        return false;
      }
      throw Failure(failure.code, fmt::format("node {} of {}: {}", next_, words_.nodes.size(), failure.what()));
    }
    sent_ += node.duration;
    ++next_;
    return true;
  }

 private:
  BoardClient& board_;
  const PathWords& words_;
  const PathScale& scale_;
  const std::vector<PathStop>& stops_;
  std::size_t next_ = 0, passed_ = 0;
  std::uint64_t sent_ = 0;
  PathStatePayload state_;
};

}  // namespace

PathBoard path_board(const firmware::ParameterValues& values, std::size_t axes, unsigned metres, bool needs_fitted) {
  PathBoard board;
  board.scale.rate_Hz = static_cast<double>(values.get<"control.rate">());
  const double inf = std::numeric_limits<double>::infinity();
  board.limits = {PathPoint::Constant(inf), PathPoint::Constant(inf), PathPoint::Constant(inf)};
  board.least = PathPoint::Constant(-inf);
  board.most = PathPoint::Constant(inf);
  board.home = PathPoint::Zero();
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const firmware::AxisValues v = values.axis(axis);
    const bool is_fitted = v.get<"drive.fitted">();
    if (needs_fitted && !is_fitted)
      throw Failure(ExitCode::refused, fmt::format("axis {} is not fitted: give it the parameters of a design "
                                                   "(axistool design, axistool set-params)",
                                                   firmware::kAxisNames.at(axis)));
    const auto i = static_cast<Eigen::Index>(axis);
    const double unit = (metres >> axis & 1u) != 0 ? 1000.0 : 1.0;
    board.scale.unit_mm.push_back(unit);
    board.scale.axes.push_back(axis);
    board.scale.count_mm.push_back(unit * static_cast<double>(v.get<"drive.encoder_resolution">()));
    board.limits.velocity[i] = unit * static_cast<double>(v.get<"limits.velocity">());
    board.limits.acceleration[i] = unit * static_cast<double>(v.get<"limits.acceleration">());
    board.limits.jerk[i] = unit * static_cast<double>(v.get<"limits.jerk">());
    board.least[i] = unit * static_cast<double>(v.get<"monitor.travel_min">());
    board.most[i] = unit * static_cast<double>(v.get<"monitor.travel_max">());
    board.home[i] = unit * static_cast<double>(v.get<"homing.position">());
  }
  return board;
}

std::vector<BoardPosition> path_start(BoardClient& board, const PathScale& scale, bool relative) {
  return positions(board.open_path(open_request(scale, {}, relative)), scale);
}

namespace {

/// Waits until the references are at rest: they lag the end of the path by the samples of their preview.
void follow_to_rest(BoardClient& board, const PathScale& scale, PathRecorder& recorder) {
  const auto until = steady_clock::now() + std::chrono::seconds(1);
  const auto moves = [](const auto& axis) { return (axis.flags & firmware::kAxisAtRest) == 0; };
  for (bool moving = true; moving && steady_clock::now() < until;) {
    board.heartbeat();
    const BoardState state = board.status();
    moving = std::ranges::any_of(scale.axes, [&](std::size_t axis) { return moves(state.axis.at(axis)); });
    recorder.fetch(milliseconds(moving ? 2 : 0));
  }
}

}  // namespace

std::size_t most_path_forces(std::size_t axes) {
  return (firmware::kWordsPerReport - 1 - kAxisWords * axes) / kForceWords;
}

PathRecorder::PathRecorder(BoardClient& board, const PathBoard& machine, std::size_t forces) : board_(board) {
  const PathScale& scale = machine.scale;
  const bool fixed_point = board.identify().fixed_point != 0;
  const BoardState status = board.status();
  const firmware::ParameterValues values = board.read_values();
  unit_mm_ = scale.unit_mm;
  capture_.mm.resize(scale.axes.size());
  capture_.reference_mm.resize(scale.axes.size());
  capture_.force.resize(forces);
  for (std::size_t i = 0; i < scale.axes.size(); ++i) order_.push_back(i);
  std::ranges::sort(order_, {}, [&](std::size_t i) { return scale.axes[i]; });
  for (std::size_t i = 0; i < scale.axes.size(); ++i) {
    const std::size_t axis = scale.axes[i];
    scales_.emplace_back(values.axis(axis), fixed_point, status.axis.at(axis).counts());
    request_.channels[axis] =
        1u << static_cast<unsigned>(Channel::counts) | 1u << static_cast<unsigned>(Channel::reference);
    if (i >= forces) continue;
    for (const Channel channel : {Channel::reference_velocity, Channel::disturbance, Channel::friction})
      request_.channels[axis] |= static_cast<std::uint16_t>(1u << static_cast<unsigned>(channel));
  }
  first_ = order_.front();
  request_.channels[scale.axes[first_]] |= 1u << static_cast<unsigned>(Channel::dac_code);
  const double rows_Hz = kMostReports_Hz * (forces == 0 ? kMostRowsAReport : 1);
  request_.every = static_cast<std::uint16_t>(std::max(1.0, std::ceil(scale.rate_Hz / rows_Hz)));
  capture_.row_period_s = request_.every / scale.rate_Hz;
}

PathRecorder::~PathRecorder() {
  try {
    if (runs_) board_.stop_capture();
  } catch (const Failure&) {  // the board is gone
  }
}

void PathRecorder::start() {
  if (runs_) return;
  board_.take_capture(request_);
  runs_ = true;
}

bool PathRecorder::fetch(milliseconds patience) {
  const auto samples = board_.next_samples(patience);
  if (!samples) return false;
  const std::size_t words = request_.words(), rows = rows_in(*samples, words);
  for (std::size_t row = 0; row < rows; ++row) {
    capture_.number.push_back(samples->first_row + static_cast<std::uint32_t>(row));
    const std::uint32_t* word = samples->words.data() + row * words;
    for (const std::size_t i : order_) {
      if (i == first_) capture_.u_V.push_back(scales_[i](Channel::dac_code, *word++));
      capture_.mm[i].push_back(unit_mm_[i] * scales_[i](Channel::counts, *word++));
      capture_.reference_mm[i].push_back(unit_mm_[i] * scales_[i](Channel::reference, *word++));
      if (i >= capture_.force.size()) continue;
      capture_.force[i].w_ref.push_back(scales_[i](Channel::reference_velocity, *word++));
      capture_.force[i].d_hat_V.push_back(scales_[i](Channel::disturbance, *word++));
      capture_.force[i].u_friction_V.push_back(scales_[i](Channel::friction, *word++));
    }
  }
  return true;
}

void PathRecorder::stop() {
  if (!runs_) return;
  for (int k = 0; k < 10; ++k) {
    fetch(milliseconds(2));
    board_.heartbeat();
  }
  capture_.dropped_by_board = board_.stop_capture().dropped;
  runs_ = false;
  while (fetch(milliseconds(50))) continue;
  capture_.lost = lost_rows(capture_.number);
}

PathOutcome run_path(BoardClient& board, const PlannedPath& path, const PathBoard& scale, bool relative,
                     PathRecorder& recorder, const std::function<PathWish(const PathProgress&)>& follow,
                     firmware::ProbeStop probe) {
  PathOutcome outcome;
  const firmware::PathUnits units = units_of(path, scale.scale);
  const auto start = positions(board.open_path(open_request(scale.scale, units, relative, probe)), scale.scale);
  const PathWords words = path_words(path, scale.scale, units, start);
  Stream stream(board, words, scale.scale, path.stops);
  try {
    while (stream.sent_s() < kHeadStart_s && stream.send()) continue;
    recorder.start();
    const std::vector<std::uint32_t>& rows = recorder.capture().number;
    while (!rows.empty() && recorder.fetch(milliseconds(0))) continue;  // discards rows at rest since an earlier path
    const std::size_t first = rows.size();
    stream.set(board.start_path());
    PathWish given;
    auto asked = steady_clock::now();
    std::size_t rows_asked = first;
    for (;;) {
      const bool sent = stream.send();
      for (int k = 0; k < kReportsARound && recorder.fetch(sent ? milliseconds(0) : milliseconds(2)); ++k) continue;
      // The time comes from the rows, because a simulated board in this process has its own clock.
      const auto now = steady_clock::now();
      if (now - asked < kRound && rows.size() < rows_asked + 16) continue;
      asked = now;
      rows_asked = rows.size();
      stream.ask();
      const auto phase = static_cast<PathPhase>(stream.state().phase);
      if (phase == PathPhase::done || phase == PathPhase::idle) break;
      const PathWish wish =
          follow({stream.state(), static_cast<double>(stream.state().elapsed) / scale.scale.rate_Hz, stream.waits()});
      if (wish.resume && stream.waits() != nullptr) stream.resume();
      if (wish.stop && !given.stop) stream.set(board.stop_path());
      if (!wish.stop && (wish.held != given.held || wish.permille != given.permille))
        stream.set(board.path_rate(
            {static_cast<std::uint16_t>(wish.permille), static_cast<std::uint8_t>(wish.held ? 1 : 0), 0}));
      given = wish;
    }
    outcome.state = stream.state();
    follow_to_rest(board, scale.scale, recorder);
    if (rows.size() > first) outcome.clock_s = recorder.capture().row_period_s * (rows.back() - rows[first] + 1);
  } catch (const Failure&) {
    try {
      board.stop_path();
    } catch (const Failure&) {  // the board is gone; the first failure is reported
    }
    throw;
  }
  return outcome;
}

std::optional<std::vector<double>> probed_mm(BoardClient& board, const PathScale& scale) {
  const firmware::ProbeStatePayload state = board.probe_state();
  if ((state.flags & firmware::kProbeMet) == 0) return std::nullopt;
  if ((state.flags & firmware::kProbeLatched) == 0)
    throw Failure(
        ExitCode::device_fault,
        "the probe changed, but the board's timers did not latch the position: check the probe's wire and its input");
  std::vector<double> mm;
  for (std::size_t i = 0; i < scale.axes.size(); ++i) {
    const auto& at = state.axis.at(scale.axes[i]);
    mm.push_back(scale.count_mm[i] * static_cast<double>(firmware::whole_counts(at.counts_low, at.counts_high)));
  }
  return mm;
}

namespace {

/// Position of a reference on the plan. The search goes only forward from the last one, as the board's clock does.
class PlanPlace {
 public:
  explicit PlanPlace(const PlannedPath& path) : path_(path) {}

  PathPoint position(double time_s) const {
    const double inside_s = std::clamp(time_s, 0.0, path_.duration_s());
    const auto next =
        std::ranges::upper_bound(path_.knots.begin() + 1, path_.knots.end() - 1, inside_s, {}, &PathKnot::time_s);
    return between(*(next - 1), *next, inside_s).position;
  }

  /// `rows`: number of rows since the previous call; each lasts `row_s`.
  double advance(const PathPoint& reference, std::uint32_t rows, double row_s) {
    // Where the axes reverse, rounding of the reference may put the nearest point before the reversal. The search then
    // stays there until its range extends beyond the reversal.
    constexpr double kLost_mm = 1e-3, kTurn_s = 0.1;
    const double usual_s = 2.0 * rows * row_s;
    if (search(reference, usual_s, row_s) > kLost_mm) search(reference, std::max(kTurn_s, usual_s), row_s);
    return time_s_;
  }

 private:
  /// Moves the position to the nearest point within this time. Returns its distance.
  double search(const PathPoint& reference, double ahead_s, double row_s) {
    constexpr double kSteps = 8.0;  // within the time of a row
    const auto steps = static_cast<std::uint32_t>(std::min(ahead_s, path_.duration_s() + row_s) / row_s * kSteps);
    double best = std::numeric_limits<double>::infinity(), best_s = time_s_;
    for (std::uint32_t i = 0; i <= steps; ++i) {
      const double tried_s = std::min(time_s_ + row_s * i / kSteps, path_.duration_s());
      const double distance = (position(tried_s) - reference).norm();
      if (distance > best + 1e-6) continue;  // of equal distances, as at rest, takes the latest
      best = std::min(best, distance);
      best_s = tried_s;
    }
    time_s_ = best_s;
    return best;
  }

  const PlannedPath& path_;
  double time_s_ = 0.0;
};

PathPoint point_of(const std::vector<std::vector<double>>& mm, std::size_t row, const PathPoint& others) {
  PathPoint point = others;
  for (std::size_t i = 0; i < mm.size(); ++i) point[static_cast<Eigen::Index>(i)] = mm[i][row];
  return point;
}

}  // namespace

std::vector<double> contour_error_um(const PathCapture& capture, const PlannedPath& path, const PathScale& scale,
                                     std::size_t begin, std::size_t end) {
  std::vector<double> error_um;
  if (path.knots.size() < 2) return std::vector<double>(end - begin, 0.0);
  PlanPlace place(path);
  PathPoint half = PathPoint::Zero();  // the encoder rounds down
  for (std::size_t i = 0; i < scale.axes.size(); ++i) half[static_cast<Eigen::Index>(i)] = scale.count_mm[i] / 2.0;
  for (std::size_t k = begin; k < end; ++k) {
    const std::uint32_t rows = k > begin ? capture.number[k] - capture.number[k - 1] : 1;
    const double time_s =
        place.advance(point_of(capture.reference_mm, k, path.knots.front().position), rows, capture.row_period_s);
    const PathPoint seen = point_of(capture.mm, k, path.knots.front().position) + half;
    // Compares with the planned motion, including the tolerances of corners, for some time to either side.
    constexpr double kWhile_s = 0.02, kStep_s = 0.001;
    double nearest = std::numeric_limits<double>::infinity();
    PathPoint last = place.position(time_s - kWhile_s);
    for (double at_s = time_s - kWhile_s + kStep_s; at_s <= time_s + kWhile_s; at_s += kStep_s) {
      const PathPoint here = place.position(at_s);
      nearest = std::min(nearest, PathCurve::line(last, here).distance_to(seen));
      last = here;
    }
    error_um.push_back(1e3 * nearest);
  }
  return error_um;
}

Record path_record(const PathCapture& capture, const PathBoard& board, const std::vector<double>& contour_um) {
  Record record;
  const std::size_t first_axis = board.scale.axes.front();
  record.drive = firmware::kAxisNames.at(first_axis);
  record.sample_period_s = capture.row_period_s;
  record.header["format"] = "axis-record/1";
  record.header["source"] = "axistool run";
  for (const std::uint32_t number : capture.number)
    record.t_s.push_back((number - capture.number.front()) * capture.row_period_s);
  record.u_V = capture.u_V;
  record.x = capture.mm.front();
  record.x_ref = capture.reference_mm.front();
  for (std::size_t i = 1; i < board.scale.axes.size(); ++i) {
    const std::string name(firmware::kAxisNames.at(board.scale.axes[i]));
    record.extra.push_back({name + "_mm", capture.mm[i], {}});
    record.extra.push_back({name + "_ref_mm", capture.reference_mm[i], {}});
  }
  record.extra.push_back({"contour_um", contour_um, {}});
  return record;
}

}  // namespace host
