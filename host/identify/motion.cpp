#include "host/identify/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/encoder_step.hpp"
#include "host/identify/smooth_acceleration.hpp"
#include "host/identify/zero_phase_filter.hpp"

namespace host {

namespace {

constexpr double kPaperDeadband_rad_s = 0.5;  // p. 1499
constexpr double kDeadbandShare = 0.1;        ///< of the top speed, for records that are slower than the paper's
constexpr double kHighestCutoff_Hz = 100.0;
constexpr double kLowestCutoff_Hz = 10.0;

double sum_of_squares(const std::vector<double>& signal) {
  double sum = 0.0;
  for (const double value : signal) sum += value * value;
  return sum;
}

void trim(std::vector<double>& signal, std::size_t margin) {
  signal.erase(signal.end() - static_cast<std::ptrdiff_t>(margin), signal.end());
  signal.erase(signal.begin(), signal.begin() + static_cast<std::ptrdiff_t>(margin));
}

/// The paper's dead band, or a tenth of the top speed if that is less, because a slow axis slides too. At least the
/// speed that noise and the encoder's last digit may show at standstill.
double usual_deadband(const std::vector<double>& speed, const sim::DataSheet& data, double cutoff_Hz, double rate_Hz) {
  if (data.kind == sim::DriveKind::linear) return 0.0;
  constexpr double kTop = 0.99, kDeviations = 3.0;
  std::vector<double> magnitude(speed.size());
  std::ranges::transform(speed, magnitude.begin(), [](double w) { return std::abs(w); });
  const auto top = magnitude.begin() + static_cast<std::ptrdiff_t>(kTop * static_cast<double>(magnitude.size() - 1));
  std::ranges::nth_element(magnitude, top);
  const double noise = kDeviations * std::sqrt(data.tach_noise_variance.value_or(0.0) * 2.0 * cutoff_Hz / rate_Hz);
  const double counts = data.encoder_resolution / data.lead * cutoff_Hz;
  return std::min(kPaperDeadband_rad_s, std::max({kDeadbandShare * *top, noise, counts}));
}

/// Marks the samples whose speed keeps its sign and stays above the dead band for `reach` samples on both sides.
std::vector<bool> slides(const std::vector<double>& speed, double deadband, std::size_t reach, std::size_t stride) {
  std::vector<std::size_t> run(speed.size());  // number of sliding samples up to and including this one
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const bool same = k > 0 && speed[k] * speed[k - 1] > 0.0;
    run[k] = std::abs(speed[k]) > deadband ? (same ? run[k - 1] : 0) + 1 : 0;
  }
  std::vector<bool> counts;
  for (std::size_t k = 0; k < speed.size(); k += stride) {
    counts.push_back(k >= reach && k + reach < speed.size() && run[k + reach] > 2 * reach);
  }
  return counts;
}

/// Lag of the speed channel behind the position in samples. It arises because a driver computes the speed from past
/// positions.
std::size_t lag_of(const std::vector<double>& speed, const std::vector<double>& by_position, double period_s) {
  constexpr double kMost_s = 0.02;
  const auto most = std::min(static_cast<std::size_t>(kMost_s / period_s), speed.size() / 4);
  std::size_t best = 0;
  double least = HUGE_VAL;
  for (std::size_t lag = 0; lag <= most; ++lag) {
    double square = 0.0;
    for (std::size_t k = most; k + 2 * most < speed.size(); ++k) square += std::pow(speed[k + lag] - by_position[k], 2);
    if (square < least) {
      least = square;
      best = lag;
    }
  }
  return best;
}

}  // namespace

std::vector<double> Motion::seen(const std::vector<double>& signal) const {
  const std::vector<double> low = decimate(signal, decimation, sample_rate_Hz);
  std::vector<double> kept;
  kept.reserve(low.size());
  for (std::size_t k = 0; k < low.size(); ++k) {
    if (counts[k]) kept.push_back(low[k]);
  }
  return kept;
}

std::vector<double> motor_effort(const Record& record, const sim::DataSheet& data) {
  std::vector<double> effort;
  effort.reserve(record.size());
  if (!record.u_V.empty()) {
    const double per_volt = data.effort_per_volt();
    if (!(per_volt > 0.0)) {
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: volts cannot be converted to {}; give {} in the [drive] table of --drive", record.path,
                      data.kind == sim::DriveKind::rotary ? "torque" : "force",
                      data.kind == sim::DriveKind::rotary ? "amplifier_gain_A_per_V and torque_constant_Nm_per_A"
                                                          : "force_constant_N_per_V"));
    }
    for (const double u : record.u_V) effort.push_back(per_volt * std::clamp(u, -data.dac_limit_V, data.dac_limit_V));
    return effort;
  }
  if (record.i_A.empty())
    throw Failure(ExitCode::bad_input, fmt::format("{}: the record has no command or current (u_V or i_A), which this "
                                                   "needs; axistool compare shows the tracking error",
                                                   record.path));
  if (!(data.torque_constant_Nm_per_A > 0.0)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: only the current was logged (i_A), which needs {} in [drive]; or log u_V", record.path,
                    data.kind == sim::DriveKind::rotary ? "torque_constant_Nm_per_A" : "force_constant_N_per_A"));
  }
  for (const double i : acting_current(record)) effort.push_back(data.torque_constant_Nm_per_A * i);
  return effort;
}

DeliveredEffort delivered_effort(const Record& record, const sim::DataSheet& data, double cutoff_Hz, bool sliding_only,
                                 const sim::Drive* command_path) {
  constexpr double kHold = 0.5;  // samples; mean age of a command that is held for a sample
  DeliveredEffort delivered;
  double late = sliding_only || record.u_V.empty() ? kHold : 0.0;  // samples
  if (command_path == nullptr || command_path->command.empty() || record.u_V.empty()) {
    delivered.effort = motor_effort(record, data);
  } else {
    Record converted;
    converted.path = record.path;
    converted.u_V = record.u_V;
    for (double& u : converted.u_V) {
      for (const auto& stage : command_path->command) u = stage(u);
    }
    delivered.effort = motor_effort(converted, data);
  }
  std::vector<double>& effort = delivered.effort;
  if (command_path != nullptr && !record.u_V.empty()) {
    const double delay_s = command_path->delay_s + command_path->current_lag_s;  // a short lag acts as a delay
    // A model with a command path implies that the command is held. Without one, command and motion are simultaneous,
    // as in published methods.
    if (delay_s > 0.0) late = delay_s / record.sample_period_s + kHold;
  }
  if (late > 0.0) {
    const auto whole = static_cast<std::size_t>(late);
    const double part = late - static_cast<double>(whole);
    for (std::size_t k = effort.size(); k-- > 0;) {
      const double later = effort[k - std::min(k, whole)], earlier = effort[k - std::min(k, whole + 1)];
      effort[k] = (1.0 - part) * later + part * earlier;
    }
    delivered.unknown_rows = std::min(whole + 1, effort.size());
  }
  if (command_path != nullptr && record.has_position()) {
    for (std::size_t k = 0; k < effort.size(); ++k) {
      for (const auto& factor : command_path->effort_factor) effort[k] *= factor(record.x[k]);
    }
  }
  effort = ZeroPhaseLowPass::butterworth(cutoff_Hz, 1.0 / record.sample_period_s)(effort);
  return delivered;
}

std::vector<double> smooth_speed(const Record& record, const sim::DataSheet& data, double cutoff_Hz, bool by_speed) {
  const auto low_pass = ZeroPhaseLowPass::butterworth(cutoff_Hz, 1.0 / record.sample_period_s);
  if (!record.has_position()) return low_pass(record.w);
  std::vector<double> by_position = central_difference(low_pass(record.x), record.sample_period_s);
  for (double& w : by_position) w /= data.lead;
  if (!by_speed) return by_position;
  std::vector<double> speed = low_pass(record.w);
  const std::size_t lag = lag_of(speed, by_position, record.sample_period_s);
  std::rotate(speed.begin(), speed.begin() + static_cast<std::ptrdiff_t>(lag), speed.end());
  return speed;
}

AccelerationNoise::AccelerationNoise(const Record& record, const sim::DataSheet& data, bool by_speed) {
  const double rate_Hz = 1.0 / record.sample_period_s;
  const double circle = 2.0 * std::numbers::pi;
  if (record.has_position() && !by_speed) {
    const double step = encoder_step(record, data) / data.lead;
    density_ = step * step / 12.0 * (2.0 / rate_Hz) * std::pow(circle, 4);
    power_ = 5.0;
  } else {
    density_ = data.tach_noise_variance.value_or(0.0) * (2.0 / rate_Hz) * circle * circle;
    power_ = 3.0;
  }
}

double AccelerationNoise::variance_below(double cutoff_Hz) const {
  return density_ * std::pow(cutoff_Hz, power_) / power_;
}

double guard_cutoff_Hz(const Motion& motion) { return decimation_cutoff_Hz(motion.decimation, motion.sample_rate_Hz); }

double choose_cutoff(const std::vector<Record>& records, const sim::DataSheet& data, bool by_speed) {
  constexpr double kNoiseShare = 0.01;
  constexpr double kStep = 0.8;
  const double rate_Hz = 1.0 / std::ranges::max_element(records, {}, &Record::sample_period_s)->sample_period_s;
  const double lowest = std::min(kLowestCutoff_Hz, rate_Hz / 50.0);
  double cutoff = std::min(kHighestCutoff_Hz, rate_Hz / 10.0);
  std::vector<AccelerationNoise> noises;
  for (const Record& record : records) noises.emplace_back(record, data, by_speed);
  while (cutoff * kStep >= lowest) {
    double noise = 0.0, signal = 0.0;
    for (std::size_t r = 0; r < records.size(); ++r) {
      const Record& record = records[r];
      const std::vector<double> speed = smooth_speed(record, data, cutoff, by_speed);
      signal += sum_of_squares(central_difference(speed, record.sample_period_s));
      noise += noises[r].variance_below(cutoff) * static_cast<double>(record.size());
    }
    if (noise <= kNoiseShare * kNoiseShare * signal) break;
    cutoff *= kStep;
  }
  return cutoff;
}

Motion prepare_motion(const Record& record, const sim::DataSheet& data, const MotionOptions& options) {
  Motion motion;
  motion.sample_rate_Hz = 1.0 / record.sample_period_s;
  motion.cutoff_Hz = options.cutoff_Hz ? *options.cutoff_Hz : choose_cutoff({record}, data, options.by_speed);
  if (!(motion.cutoff_Hz > 0.0) || motion.cutoff_Hz >= 0.5 * motion.sample_rate_Hz) {
    throw Failure(ExitCode::usage, fmt::format("--cutoff is {} Hz but must lie between 0 and half the sampling rate of "
                                               "{} ({} Hz)",
                                               motion.cutoff_Hz, record.path, 0.5 * motion.sample_rate_Hz));
  }
  const bool sliding_only = options.deadband ? *options.deadband > 0.0 : data.kind == sim::DriveKind::rotary;
  const double samples_per_cutoff = motion.sample_rate_Hz / motion.cutoff_Hz;
  const auto usual = sliding_only ? std::size_t{1} : static_cast<std::size_t>(std::lround(samples_per_cutoff));
  motion.decimation = std::max<std::size_t>(1, options.decimation.value_or(usual));
  if (static_cast<double>(record.size()) <
      20.0 * std::max(samples_per_cutoff, static_cast<double>(motion.decimation))) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {} samples are too few for a filter at {:g} Hz; record at least {:.2g} s",
                              record.path, record.size(), motion.cutoff_Hz, 20.0 / motion.cutoff_Hz));
  }

  const auto low_pass = ZeroPhaseLowPass::butterworth(motion.cutoff_Hz, motion.sample_rate_Hz);
  motion.t_s = record.t_s;
  motion.travel = record.has_position() ? low_pass(record.x) : std::vector<double>(record.size());
  motion.speed = smooth_speed(record, data, motion.cutoff_Hz, options.by_speed);
  motion.deadband = options.deadband ? *options.deadband
                                     : usual_deadband(motion.speed, data, motion.cutoff_Hz, motion.sample_rate_Hz);
  motion.acceleration = smooth_acceleration(record, data, motion.cutoff_Hz, options.by_speed, motion.speed);
  DeliveredEffort delivered = delivered_effort(record, data, motion.cutoff_Hz, sliding_only, options.command_path);
  motion.effort = std::move(delivered.effort);

  for (auto* signal : {&motion.t_s, &motion.travel, &motion.speed, &motion.acceleration, &motion.effort}) {
    trim(*signal, kMotionMargin);
  }
  const auto reach = static_cast<std::size_t>(std::ceil(0.5 * samples_per_cutoff)) + motion.decimation / 2;
  if (sliding_only) {
    motion.counts = slides(motion.speed, motion.deadband, reach, motion.decimation);
  } else {
    motion.counts.assign((motion.speed.size() + motion.decimation - 1) / motion.decimation, true);
    // Excludes samples in which the filter includes commands from before the record.
    const std::size_t first = delivered.unknown_rows > 0 ? delivered.unknown_rows + reach : 0;
    for (std::size_t k = 0; k < motion.counts.size() && k * motion.decimation + kMotionMargin < first; ++k)
      motion.counts[k] = false;
  }
  return motion;
}

}  // namespace host
