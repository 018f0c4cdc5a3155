#include "host/evidence/position_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "host/identify/encoder_step.hpp"
#include "host/statistics.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

constexpr double kEffortMargin = 5.0;  ///< of the full torque or force; no model error explains more
constexpr double kStepMargin = 3.0;    ///< encoder steps that quantisation and interpolation may add
constexpr double kJitter = 3.0;        ///< samples of travel that clock jitter may add or remove
constexpr int kFewestBits = 8;

/// The number of encoder steps if it is a power of two, otherwise 0.
double counter_range(double steps) {
  const int bits = static_cast<int>(std::lround(std::log2(steps)));
  constexpr double kTolerance = 2.0;  // steps
  return bits >= kFewestBits && std::abs(steps - std::exp2(bits)) <= kTolerance ? std::exp2(bits) : 0.0;
}

/// The range at which an angle wraps: all jumps have the same size, against the motion, and the position stays within
/// that range. If the range equals a turn of the shaft, exactly one turn. 0 if nothing wraps.
double angle_range(const Record& record, const std::vector<double>& sizes, double turn) {
  constexpr std::size_t kFewest = 2;
  constexpr double kAlike = 0.01;
  if (sizes.size() < kFewest) return 0.0;
  const double range = median(sizes);
  const auto [low, high] = std::ranges::minmax(record.x);
  const auto alike = [range](double size) { return std::abs(size - range) < kAlike * range; };
  if (!std::ranges::all_of(sizes, alike) || high - low > (1.0 + kAlike) * range) return 0.0;
  return record.kind == sim::DriveKind::rotary && alike(turn) ? turn : range;
}

/// The 99 % quantile of the difference between successive steps. It is used as the limit of the drive if the inertia is
/// unknown.
double usual_change(const std::vector<double>& x) {
  constexpr double kUsual = 0.99;
  std::vector<double> changes;
  for (std::size_t k = 2; k < x.size(); ++k) changes.push_back(std::abs(x[k] - 2.0 * x[k - 1] + x[k - 2]));
  return quantile(std::move(changes), kUsual);
}

/// Whether the step to row `k` makes up for slower steps before it, so that the mean speed over all of them is
/// unchanged. The rows between were then late or repeated.
bool catches_up(const std::vector<double>& x, std::size_t k) {
  constexpr std::size_t kMostRows = 50, kAround = 20;
  constexpr double kSlow = 0.6, kKept = 0.5;  // of the speed; before a new zero no readings repeat
  std::vector<double> steps;
  for (std::size_t row = k < kAround ? 1 : k - kAround + 1; row < std::min(k + kAround, x.size()); ++row)
    steps.push_back(x[row] - x[row - 1]);
  const double speed = median(std::move(steps));
  for (std::size_t rows = 2; rows <= kMostRows && rows < k; ++rows) {
    if (std::abs(x[k - rows + 1] - x[k - rows]) > kSlow * std::abs(speed)) return false;
    const double travel = x[k] - x[k - rows], expected = static_cast<double>(rows) * speed;
    if (std::abs(travel - expected) < kKept * std::abs(expected)) return true;
  }
  return false;
}

/// Median of the nonzero steps; 0 if there are none. If readings repeat over several rows or are coarse, a step is
/// large compared with its neighbours but not with this median.
double usual_step(const std::vector<double>& x) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < x.size(); ++k)
    if (x[k] != x[k - 1]) steps.push_back(std::abs(x[k] - x[k - 1]));
  return steps.empty() ? 0.0 : median(std::move(steps));
}

void note(std::size_t& count, PositionJump& first, std::size_t more, double t_s, double size) {
  if (count == 0) first = {t_s, size};
  count += more;
}

}  // namespace

PositionJumps position_jumps(const Record& record, const sim::DriveDescription& model) {
  PositionJumps jumps;
  const sim::Drive drive(model);
  const double resolution = encoder_step(record, model.data);
  if (!record.has_position() || record.size() < 5 || !(resolution > 0.0)) return jumps;
  const double period_s = record.sample_period_s;
  double largest_V = model.data.dac_limit_V;
  for (const double u_V : record.u_V) largest_V = std::max(largest_V, std::abs(u_V));
  const auto step = [&](std::size_t k) { return record.x[k] - record.x[k - 1]; };
  const double per_sample = drive.inertia > 0.0
                                ? drive.effort_per_volt * largest_V / drive.inertia * period_s * period_s * drive.lead
                                : usual_change(record.x);
  const double impossible = kEffortMargin * per_sample + kStepMargin * resolution;
  const double usual = usual_step(record.x);
  // How far a step exceeds the steps around it.
  const auto excess = [&](std::size_t k) { return step(k) - 0.5 * (step(k - 1) + step(k + 1)); };
  std::vector<double> against_the_motion;  // sizes of the jumps
  for (std::size_t k = 3; k + 2 < record.size(); ++k) {
    const double before = step(k - 1), after = step(k + 1), jump = excess(k);
    if (step(k) == 0.0 && std::abs(before) > impossible && after * before > 0.0 &&
        std::abs(after) > 1.5 * std::abs(before)) {
      note(jumps.dropped, jumps.first_drop, 1, record.t_s[k], before);
      k += 2;
      continue;
    }
    if (std::abs(jump) <= impossible || std::abs(jump) < std::abs(excess(k - 1)) ||
        std::abs(jump) < std::abs(excess(k + 1)))
      continue;
    const double speed = 0.5 * (before + after);
    const double samples = speed == 0.0 ? 0.0 : jump / speed;
    constexpr double kMostSamples = 50.0;
    constexpr double kWhole = 0.1;  // of a sample; over a few samples the speed hardly changes
    const bool whole = samples > 0.5 && samples < kMostSamples &&
                       std::abs(samples - std::round(samples)) < kWhole + 3.0 * resolution / std::abs(speed) &&
                       std::abs(before - after) < 0.2 * std::abs(speed);
    if (const double steps = counter_range(std::abs(jump) / resolution); steps > 0.0 && jump * speed <= 0.0) {
      note(jumps.wraps, jumps.first_wrap, 1, record.t_s[k], jump);
      jumps.wrap_range = steps * resolution;
    } else if (whole) {
      note(jumps.dropped, jumps.first_drop, static_cast<std::size_t>(std::lround(samples)), record.t_s[k], jump);
    } else if (catches_up(record.x, k)) {
      note(jumps.late, jumps.first_late, 1, record.t_s[k], jump);
    } else if (std::abs(jump) > kJitter * std::max({std::abs(before), std::abs(after), usual})) {
      note(jumps.new_zeros, jumps.first_new_zero, 1, record.t_s[k], jump);
      if (jump * speed <= 0.0) against_the_motion.push_back(std::abs(jump));
    }
    ++k;  // the steps next to a jump are not jumps
  }
  if (against_the_motion.size() == jumps.new_zeros && jumps.wraps == 0) {
    const double range = angle_range(record, against_the_motion, 2.0 * std::numbers::pi * model.data.lead);
    if (range > 0.0) {
      jumps.wraps = std::exchange(jumps.new_zeros, 0);
      jumps.first_wrap = jumps.first_new_zero;
      jumps.wrap_range = range;
    }
  }
  return jumps;
}

}  // namespace host
