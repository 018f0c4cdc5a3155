// Speed, acceleration and torque or force of a record, without delay, for the inverse model T = J dw/dt + friction(w).
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// How the signals are prepared. The dead band selects one of two methods.
/// * Dead band > 0: only samples in which the axis certainly slides are used: the speed stays above the dead band for
/// the length of the filter. The command is taken in the middle of its hold. No decimation.
/// * Dead band 0: every sample is used, as in published inverse-model identification (parallel filtering): all signals,
/// including the sign of the speed, pass through the same steep filter and are decimated. The command is taken at its
/// sample.
struct MotionOptions {
  /// rad/s or m/s. Default 0.5 rad/s (the paper, p. 1499), or a tenth of the top speed if that is less; 0 for a linear
  /// drive.
  std::optional<double> deadband;
  std::optional<double> cutoff_Hz;        ///< default: choose_cutoff
  std::optional<std::size_t> decimation;  ///< default 1 with a dead band, else sample rate / cut-off
  /// Drive whose command path (converter, delay, torque constant along the travel) is between command and motor. If
  /// null, the command acts unchanged.
  const sim::Drive* command_path = nullptr;
  /// Takes speed and acceleration from the speed channel even if there is a position. Its lag behind the position is
  /// removed.
  bool by_speed = false;
};

/// The signals of one record at its own sample rate, without the two samples at each end that have no central
/// differences.
struct Motion {
  double sample_rate_Hz = 0.0;
  double cutoff_Hz = 0.0;
  double deadband = 0.0;
  std::size_t decimation = 1;
  std::vector<double> t_s;
  std::vector<double> travel;        ///< filtered, mm or m; zeros if the record has no position
  std::vector<double> speed;         ///< from the position, or from the speed channel (smooth_speed)
  std::vector<double> acceleration;  ///< rad/s^2 or m/s^2
  std::vector<double> effort;        ///< torque or force of the motor, filtered, Nm or N
  std::vector<bool> counts;          ///< per decimated sample: true if it is used

  /// Reduces a signal of full rate to the samples of the regression: decimated, and only those in use.
  std::vector<double> seen(const std::vector<double>& signal) const;
};

/// Torque or force of the motor from the record's command (limited by the converter) or current, unfiltered. Throws
/// Failure(bad_input) if constants of the drive are missing.
std::vector<double> motor_effort(const Record& record, const sim::DataSheet& data);

/// Noise of the acceleration due to the sensor of a record: encoder steps, or tachometer noise if there is no encoder
/// or the speed channel was requested.
class AccelerationNoise {
 public:
  AccelerationNoise(const Record& record, const sim::DataSheet& data, bool by_speed = false);

  /// Variance of the acceleration below a cut-off frequency, (rad/s^2)^2 or (m/s^2)^2.
  double variance_below(double cutoff_Hz) const;

 private:
  double density_ = 0.0, power_ = 1.0;
};

/// Cut-off of the guard filter before a motion's decimation, Hz.
double guard_cutoff_Hz(const Motion& motion);

/// motor_effort() after a drive's command path and the filter, at the times of the samples.
struct DeliveredEffort {
  std::vector<double> effort;    ///< Nm or N, one value per row
  std::size_t unknown_rows = 0;  ///< rows at the start with a command from before the record
};
DeliveredEffort delivered_effort(const Record& record, const sim::DataSheet& data, double cutoff_Hz, bool sliding_only,
                                 const sim::Drive* command_path);

/// Speed of the shaft from the encoder after the zero-phase filter, or from the speed channel if there is no encoder or
/// the channel was requested. The lag of the speed channel of up to 20 ms is removed; it arises because a driver
/// computes the speed from past positions.
std::vector<double> smooth_speed(const Record& record, const sim::DataSheet& data, double cutoff_Hz,
                                 bool by_speed = false);

/// Cut-off for these records: a tenth of the lowest sampling rate, at most 100 Hz (resonances lie above), lowered until
/// the acceleration noise of the sensor (encoder steps, tachometer noise) is below 1 % of the acceleration. Not below
/// 10 Hz, or below a fiftieth of the sampling rate if that is lower.
double choose_cutoff(const std::vector<Record>& records, const sim::DataSheet& data, bool by_speed = false);

/// The speed channel is used if its residual is at most this share of the residual of the position. A differentiated
/// position with jitter or coarse resolution is noisy, but a tachometer has its own errors.
inline constexpr double kClearlyBetterBySpeed = 0.8;

/// Rows that prepare_motion() leaves out at each end, because two successive differences need both neighbours.
inline constexpr std::size_t kMotionMargin = 2;

/// Prepares one record. Throws Failure(bad_input) for a record that is too short for the filter.
Motion prepare_motion(const Record& record, const sim::DataSheet& data, const MotionOptions& options);

}  // namespace host
