// Speed, acceleration and torque or force of a record, without delay, for the inverse model T = J dw/dt + friction(w).
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// How the signals are prepared. Two recipes, chosen by the dead band:
/// * dead band > 0: only samples count at which the axis certainly slides: the speed stays beyond the dead band as far
/// as the filter reaches. The command is taken in the middle of its hold. No decimation.
/// * dead band 0: every sample counts, as in published inverse-model identification (parallel filtering): all signals,
///   the sign of the speed included, pass the same steep filter and are decimated. The command counts at its sample.
struct MotionOptions {
  /// rad/s or m/s; default 0.5 rad/s (the paper, p. 1499), or a tenth of the top speed where that is less; linear 0
  std::optional<double> deadband;
  std::optional<double> cutoff_Hz;        ///< default: choose_cutoff
  std::optional<std::size_t> decimation;  ///< default 1 with a dead band, else sample rate / cut-off
  /// Drive whose command path is between command and motor (converter, delay, torque constant along the travel); none:
  /// a command acts unchanged.
  const sim::Drive* command_path = nullptr;
  /// Takes speed and acceleration from the speed channel even if there is a position; its lag behind the position is
  /// removed.
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

  /// Reduces a signal of full rate to the samples of the regression: decimated, and only those that count.
  std::vector<double> seen(const std::vector<double>& signal) const;
};

/// Effort of the motor from the record's command (limited by the converter) or current, unfiltered.
/// Throws Failure(bad_input) when the drive's constants are missing.
std::vector<double> motor_effort(const Record& record, const sim::DataSheet& data);

/// Noise of the acceleration due to a record's sensor: encoder steps, or tachometer noise if there is no encoder or the
/// speed channel was requested.
class AccelerationNoise {
 public:
  AccelerationNoise(const Record& record, const sim::DataSheet& data, bool by_speed = false);

  /// (rad/s^2)^2 or (m/s^2)^2.
  double variance_below(double cutoff_Hz) const;

 private:
  double density_ = 0.0, power_ = 1.0;
};

/// Cut-off of the guard filter before a motion's decimation, Hz.
double guard_cutoff_Hz(const Motion& motion);

/// motor_effort through a drive's command path and the filter, at the instants of the samples.
struct DeliveredEffort {
  std::vector<double> effort;    ///< Nm or N, one a row
  std::size_t unknown_rows = 0;  ///< at the start: their effort was commanded before the record began
};
DeliveredEffort delivered_effort(const Record& record, const sim::DataSheet& data, double cutoff_Hz, bool sliding_only,
                                 const sim::Drive* command_path);

/// The record's shaft speed from its encoder after the zero-phase filter, or from the speed channel if there is no
/// encoder or the channel was requested. Its lag of up to 20 ms is removed, because a driver computes it from past
/// positions.
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
