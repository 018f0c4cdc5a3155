#include "host/compare/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace host {

namespace {

/// Builds the states that windows restart from, as a drive understands the record: hidden states follow the motion
/// before the window, and a drive whose encoder errs or whose command arrives changed sees another motion behind the
/// same readings.
class Restarts {
 public:
  Restarts(const sim::Drive& drive, const PreparedRecord& prepared)
      : drive_(drive),
        prepared_(prepared),
        motion_(prepared.motion()),
        memory_(static_cast<std::size_t>(std::ceil(drive.memory_s() / prepared.period_s))),
        errs_(!drive.encoder_error.empty()),
        shapes_(drive.shapes_effort()) {
    if (errs_) reading_.resize(motion_.x.size());
    if (shapes_) command_V_.resize(motion_.x.size());
  }

  /// Windows must be asked for in rising order.
  sim::DriveState at(const Window& window) {
    const std::size_t row = window.begin;
    const bool shifts = errs_ || shapes_;
    if (memory_ == 0 && !shifts) return drive_.at(motion_.x[row], motion_.w[row]);
    // Rows further back than the drive remembers need not be gone through.
    const std::size_t needed = row - std::min(row, rows_back(row) + (shifts ? prepared_.smoother.reach() : 0));
    here_.begin_at(needed, *this);
    while (here_.row < row) follow(here_);
    return shifts ? shifted(here_.state, needed, prepared_.weights_of(window)) : here_.state;
  }

 private:
  /// The drive's state as it goes along the measured motion.
  struct Follower {
    sim::DriveState state;
    std::size_t row = 0;
    bool begun = false;

    void begin_at(std::size_t needed, const Restarts& restarts) {
      if (begun && needed <= row) return;
      state = restarts.drive_.at(restarts.motion_.x[needed], restarts.motion_.w[needed]);
      row = needed;
      begun = true;
    }
  };

  /// Rest keeps what the motion before it has left: where a second mass stands in its gap, how a bristle is bent.
  std::size_t rows_back(std::size_t row) const {
    if (memory_ == 0) return 0;
    std::size_t back = std::min(row, memory_);
    while (back < row && motion_.standing[row - back]) ++back;
    return std::min(row, back + memory_);
  }

  /// Goes on by a row; returns the effort that the drive delivers meanwhile.
  double follow(Follower& follower) const {
    const std::size_t row = follower.row++;
    return drive_.follow(follower.state, prepared_.u_V[row], motion_.x[row + 1], motion_.w[row + 1],
                         prepared_.record->t_s[row], prepared_.period_s);
  }

  sim::DriveState shifted(sim::DriveState restart, std::size_t needed, const ShiftWeights& weights) {
    const std::size_t count = weights.x_of_reading.size();
    ahead_.begin_at(std::min(needed, weights.first), *this);
    while (ahead_.row < weights.first + count) {
      const std::size_t row = ahead_.row;
      if (errs_) {
        const double x = motion_.x[row];
        reading_[row] = -drive_.encoder_error_at(x - drive_.encoder_error_at(x));
      }
      const double effort = follow(ahead_);
      if (shapes_) command_V_[row] = effort / drive_.effort_per_volt - prepared_.u_V[row];
    }
    const auto reached = [&](const std::vector<double>& changes) {
      return changes.empty() ? std::span<const double>{} : std::span(changes).subspan(weights.first, count);
    };
    const ShiftWeights::Shift shift = weights.shift(reached(reading_), reached(command_V_));
    restart.x += shift.x;
    restart.w += shift.w;
    if (!drive_.has_second_mass()) restart.load_x = restart.x;
    return restart;
  }

  const sim::Drive& drive_;
  const PreparedRecord& prepared_;
  const SmoothedMotion& motion_;
  std::size_t memory_;
  bool errs_, shapes_;
  Follower here_;
  Follower ahead_;  ///< of here_, by what a row's readings reach back
  std::vector<double> reading_, command_V_;
};

}  // namespace

std::vector<sim::DriveState> restart_states(const sim::Drive& drive, const PreparedRecord& prepared,
                                            std::size_t stride) {
  std::vector<sim::DriveState> states;
  states.reserve(prepared.windows.size() / stride + 1);
  Restarts restarts(drive, prepared);
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride)
    states.push_back(restarts.at(prepared.windows[index]));
  return states;
}

void run_side_by_side(const sim::Drive& drive, const PreparedRecord& prepared, std::span<WindowRun> runs) {
  std::size_t longest = 0;
  for (const WindowRun& run : runs) longest = std::max(longest, run.window->length);
  for (std::size_t k = 0; k < longest; ++k) {
    for (WindowRun& run : runs) {
      if (k >= run.window->length) continue;
      const std::size_t row = run.window->begin + k;
      drive.step(run.state, prepared.u_V[row], prepared.record->t_s[row], prepared.period_s);
      run.x[k] = drive.encoder(run.state);
      run.w[k] = drive.tachometer(run.state);
    }
  }
}

void predict(const sim::Drive& drive, const PreparedRecord& prepared, Prediction& out, std::size_t stride) {
  out.x.resize(prepared.record->size());
  out.w.resize(prepared.record->size());
  Restarts restarts(drive, prepared);
  std::vector<WindowRun> runs;
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
    const Window& window = prepared.windows[index];
    runs.push_back({&window, restarts.at(window), &out.x[window.begin + 1], &out.w[window.begin + 1]});
    if (runs.size() < kSideBySide && index + stride < prepared.windows.size()) continue;
    run_side_by_side(drive, prepared, runs);
    runs.clear();
  }
}

}  // namespace host
