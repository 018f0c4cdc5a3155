#include "host/compare/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

namespace host {

namespace {

/// Computes the states from which windows restart. The model of the drive interprets the record: hidden states follow
/// the motion before the window, and with an encoder error or a changed command the same readings mean a different
/// motion.
class Restarts {
 public:
  Restarts(const sim::Drive& drive, const PreparedRecord& prepared, std::size_t stride)
      : drive_(drive),
        prepared_(prepared),
        motion_(prepared.motion()),
        stride_(stride),
        memory_(static_cast<std::size_t>(std::ceil(drive.memory_s() / prepared.period_s))),
        errs_(!drive.has_second_mass() && !drive.encoder_error.empty()),
        shapes_(!drive.has_second_mass() && drive.shapes_effort()) {
    if (errs_) reading_.resize(motion_.x.size());
    if (shapes_) command_V_.resize(motion_.x.size());
  }

  /// Must be called for every stride-th window, in ascending order.
  sim::DriveState at(std::size_t index) {
    const Window& window = prepared_.windows[index];
    const std::size_t row = window.begin;
    const bool shifts = errs_ || shapes_;
    if (memory_ == 0 && !shifts) return drive_.at(motion_.x[row], motion_.w[row]);
    const ShiftWeights* weights = shifts ? &prepared_.weights_of(window) : nullptr;
    // Rows that are too old to affect the state of the drive are skipped.
    std::size_t needed = row - std::min(row, rows_back(row) + (shifts ? prepared_.smoother->reach() : 0));
    if (shifts) needed = std::min(needed, weights->first);
    if (!begun_ || needed > row_) begin_at(needed, index);
    follow_to(row);
    sim::DriveState state = kept_.front();
    kept_.pop_front();
    return shifts ? shifted(state, *weights) : state;
  }

 private:
  /// Two masses are observed by a separate simulation, which needs the drive's command and the true travel. One mass
  /// follows the readings, and the drive's corrections are added afterwards.
  double followed_travel(std::size_t row) const {
    return drive_.has_second_mass() ? drive_.travel_at_reading(motion_.x[row]) : motion_.x[row];
  }

  void begin_at(std::size_t row, std::size_t index) {
    state_ = drive_.at(followed_travel(row), motion_.w[row]);
    if (row == 0) state_.rest_s = rest_before();
    row_ = row;
    stood_ = 0;
    next_kept_ = index;
    begun_ = true;
    keep();
  }

  /// Least time for which the drive has stood before its record begins: under the torque or force of its first rest, a
  /// drive that had just stopped would have moved.
  double rest_before() const {
    // A motion that begins within the last rows of a rest does not show yet.
    constexpr double kUnseen_s = 0.03;
    if (drive_.dwell_gain <= 0.0) return 0.0;
    std::size_t end = 0;
    while (end < motion_.standing.size() && motion_.standing[end]) ++end;
    const auto unseen = static_cast<std::size_t>(std::ceil(kUnseen_s / prepared_.period_s));
    sim::DriveState standing = state_;
    double least_s = 0.0;
    for (std::size_t row = 0; row + unseen < end; ++row) {
      const double t_s = prepared_.record->t_s[row];
      const double effort = drive_.follow(standing, prepared_.u_V[row], followed_travel(row + 1), motion_.w[row + 1],
                                          t_s, prepared_.period_s);
      const double passed_s = static_cast<double>(row + 1) * prepared_.period_s;
      least_s = std::max(least_s, drive_.rest_to_hold(standing, effort, t_s) - passed_s);
    }
    return least_s;
  }

  /// The corrected readings of a window depend on rows after the start of the following windows. So the states at these
  /// starts are stored on the way.
  void keep() {
    while (next_kept_ < prepared_.windows.size() && prepared_.windows[next_kept_].begin <= row_) {
      kept_.push_back(state_);
      next_kept_ += stride_;
    }
  }

  /// A second mass that has settled at rest keeps its state. Returns the first row, at most `row`, that must be
  /// followed again: its memory before the next motion.
  std::size_t end_of_settled(std::size_t row) const {
    if (!drive_.has_second_mass() || drive_.dwell_gain > 0.0 || stood_ < memory_) return row_;
    std::size_t end = row_;
    while (end < row + memory_ && end < motion_.standing.size() && motion_.standing[end]) ++end;
    return std::min(row, end - std::min(end, memory_));
  }

  void follow_to(std::size_t row) {
    while (row_ < row) {
      if (const std::size_t end = end_of_settled(row); end > row_) {
        row_ = end;
        keep();
        continue;
      }
      stood_ = motion_.standing[row_] ? stood_ + 1 : 0;
      if (errs_) {
        const double x = motion_.x[row_];
        reading_[row_] = drive_.travel_at_reading(x) - x;
      }
      const double effort = drive_.follow(state_, prepared_.u_V[row_], followed_travel(row_ + 1), motion_.w[row_ + 1],
                                          prepared_.record->t_s[row_], prepared_.period_s);
      if (shapes_) command_V_[row_] = effort / drive_.effort_per_volt - prepared_.u_V[row_];
      ++row_;
      keep();
    }
  }

  /// At rest, hidden states keep their value from the previous motion, for example the position of a second mass in its
  /// gap or the deflection of a bristle.
  std::size_t rows_back(std::size_t row) const {
    if (memory_ == 0) return 0;
    std::size_t back = std::min(row, memory_);
    while (back < row && motion_.standing[row - back]) ++back;
    return std::min(row, back + memory_);
  }

  sim::DriveState shifted(sim::DriveState restart, const ShiftWeights& weights) {
    const std::size_t count = weights.x_of_reading.size();
    follow_to(weights.first + count);
    const auto reached = [&](const std::vector<double>& changes) {
      return changes.empty() ? std::span<const double>{} : std::span(changes).subspan(weights.first, count);
    };
    const ShiftWeights::Shift shift = weights.shift(reached(reading_), reached(command_V_));
    restart.x += shift.x;
    restart.w += shift.w;
    restart.load_x = restart.x;
    return restart;
  }

  const sim::Drive& drive_;
  const PreparedRecord& prepared_;
  const SmoothedMotion& motion_;
  std::size_t stride_;
  std::size_t memory_;
  bool errs_, shapes_;
  sim::DriveState state_;  ///< state of the drive along the measured motion
  std::size_t row_ = 0;
  std::size_t stood_ = 0;  ///< rows at rest that were followed
  bool begun_ = false;
  std::deque<sim::DriveState> kept_;  ///< states at the starts of windows that are not yet requested
  std::size_t next_kept_ = 0;
  std::vector<double> reading_, command_V_;
};

}  // namespace

std::vector<sim::DriveState> restart_states(const sim::Drive& drive, const PreparedRecord& prepared,
                                            std::size_t stride) {
  std::vector<sim::DriveState> states;
  states.reserve(prepared.windows.size() / stride + 1);
  Restarts restarts(drive, prepared, stride);
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride) states.push_back(restarts.at(index));
  return states;
}

void run_side_by_side(const sim::Drive& drive, const PreparedRecord& prepared, std::span<WindowRun> runs) {
  std::size_t longest = 0;
  for (const WindowRun& run : runs) longest = std::max(longest, run.window->length);
  for (std::size_t k = 0; k < longest; ++k) {
    for (WindowRun& run : runs) {
      if (k >= run.window->length) continue;
      const std::size_t row = run.window->begin + k;
      prepared.held.step(drive, run.state, row);
      run.x[k] = drive.encoder(run.state);
      run.w[k] = drive.tachometer(run.state);
      if (run.table != nullptr) run.table[k] = drive.table(run.state, prepared.record->t_s[row] + prepared.period_s);
    }
  }
}

void predict(const sim::Drive& drive, const PreparedRecord& prepared, Prediction& out, std::size_t stride) {
  out.x.resize(prepared.record->size());
  out.w.resize(prepared.record->size());
  const bool has_table = prepared.record->has_table_position();
  if (has_table) out.table.resize(prepared.record->size());
  Restarts restarts(drive, prepared, stride);
  std::vector<WindowRun> runs;
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
    const Window& window = prepared.windows[index];
    runs.push_back({&window, restarts.at(index), &out.x[window.begin + 1], &out.w[window.begin + 1],
                    has_table ? &out.table[window.begin + 1] : nullptr});
    if (runs.size() < kSideBySide && index + stride < prepared.windows.size()) continue;
    run_side_by_side(drive, prepared, runs);
    runs.clear();
  }
}

}  // namespace host
