// Speed, acceleration and torque or force of a record, without delay, for the inverse model T = J dw/dt + friction(w).
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// How the signals are prepared. Two recipes, chosen by the dead band:
/// * dead band > 0: only samples count that slide for sure, that is whose speed stays beyond the dead band as far as
///   the filter reaches. The command is taken in the middle of its hold. No decimation.
/// * dead band 0: every sample counts, as in published inverse-model identification (parallel filtering): all signals,
///   the sign of the speed included, pass the same steep filter and are decimated. The command counts at its sample.
struct MotionOptions {
  /// rad/s or m/s; default 0.5 rad/s (the paper, p. 1499), or a tenth of the top speed where that is less; linear 0
  std::optional<double> deadband;
  std::optional<double> cutoff_Hz;        ///< default: choose_cutoff
  std::optional<std::size_t> decimation;  ///< default 1 with a dead band, else sample rate / cut-off
  /// Whose command path stands between command and motor (converter, delay, torque constant along the travel); none: a
  /// command acts as it was sent.
  const sim::Drive* command_path = nullptr;
  /// Speed and acceleration from the speed channel, though there is a position; its lag behind that is taken out.
  bool by_speed = false;
};

/// One record's signals at its own rate, without the two samples at each end whose differences lack a neighbour.
struct Motion {
  double sample_rate_Hz = 0.0;
  double cutoff_Hz = 0.0;
  double deadband = 0.0;
  std::size_t decimation = 1;
  std::vector<double> t_s;
  std::vector<double> travel;        ///< filtered, mm or m; zeros where the record has no position
  std::vector<double> speed;         ///< from the position, or from the speed channel (smooth_speed)
  std::vector<double> acceleration;  ///< rad/s^2 or m/s^2
  std::vector<double> effort;        ///< of the motor, filtered, Nm or N
  std::vector<bool> counts;          ///< by decimated sample: whether it may be used

  /// A signal of full rate passed through what the regression sees: decimated, and only the samples that count.
  std::vector<double> seen(const std::vector<double>& signal) const;
};

/// Effort of the motor from the record's command (limited by the converter) or current, unfiltered.
/// Throws Failure(bad_input) when the drive's constants are missing.
std::vector<double> motor_effort(const Record& record, const sim::DataSheet& data);

/// What a record's sensor leaves on the acceleration: encoder steps, or tachometer noise where there is no encoder or
/// the speed channel was asked for.
class AccelerationNoise {
 public:
  AccelerationNoise(const Record& record, const sim::DataSheet& data, bool by_speed = false);

  /// (rad/s^2)^2 or (m/s^2)^2.
  double variance_below(double cutoff_Hz) const;

 private:
  double density_ = 0.0, power_ = 1.0;
};

/// Where the guard filter in front of a motion's decimation cuts off, Hz.
double guard_cutoff_Hz(const Motion& motion);

/// motor_effort through a drive's command path and the filter, at the instants of the samples.
struct DeliveredEffort {
  std::vector<double> effort;    ///< Nm or N, one a row
  std::size_t unknown_rows = 0;  ///< at the start: what acts there was sent before the record began
};
DeliveredEffort delivered_effort(const Record& record, const sim::DataSheet& data, double cutoff_Hz, bool sliding_only,
                                 const sim::Drive* command_path);

/// The record's shaft speed from its encoder after the zero-phase filter, or from the speed channel where there is no
/// encoder or that is asked for: then without its lag, up to 20 ms, for a driver computes it from positions that have
/// been.
std::vector<double> smooth_speed(const Record& record, const sim::DataSheet& data, double cutoff_Hz,
                                 bool by_speed = false);

/// Cut-off for these records: a tenth of the lowest sampling rate, at most 100 Hz (above lie resonances, not the rigid
/// axis), lowered until the acceleration noise that the sensor leaves (encoder steps, tachometer noise) is below 1 % of
/// the acceleration itself, but not below 10 Hz (or a fiftieth of the sampling rate, if that is lower).
double choose_cutoff(const std::vector<Record>& records, const sim::DataSheet& data, bool by_speed = false);

/// The derivative of a position with jitter or coarse resolution is noisy, but a tachometer has its own errors. The
/// speed channel is used if its residual is at most this share of the position's.
inline constexpr double kClearlyBetterBySpeed = 0.8;

/// Rows that prepare_motion() leaves out at each end: two differences, each of which needs both neighbours.
inline constexpr std::size_t kMotionMargin = 2;

/// Prepares one record. Throws Failure(bad_input) for a record that is too short for the filter.
Motion prepare_motion(const Record& record, const sim::DataSheet& data, const MotionOptions& options);

}  // namespace host
