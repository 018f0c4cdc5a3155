// Records and noise floors with which models are compared, and the error measure.
#pragma once

#include <memory>
#include <vector>

#include "host/compare/effort_prediction.hpp"
#include "host/compare/error_floor.hpp"
#include "host/compare/prediction.hpp"

namespace host {

/// Measure of comparison.
enum class Measure {
  motion,  ///< predicted and measured travel and speed
  effort   ///< torque or force of the inverse model and of the motor; needs an inverse
};

/// A record with the noise floor of each of its windows.
struct ComparedRecord {
  PreparedRecord prepared;
  ErrorFloor floor;
  std::shared_ptr<const EffortRecord> effort = nullptr;  ///< if the measure is torque or force
};

/// Three noise floors squared. A single late impact or breakaway must not outweigh all windows that fit.
inline constexpr double kCommonSquare = 9.0;

/// The records for one purpose (training or validation).
struct RecordSet {
  std::vector<ComparedRecord> records;
  Measure measure = Measure::motion;
  std::size_t stride = 1;  ///< uses every stride-th window; more than 1 makes a search faster
  /// In a fit, a window has full weight up to this squared error over squared noise floor. Above it, its contribution
  /// grows as the logarithm. At least kCommonSquare.
  double common_square = kCommonSquare;

  std::size_t used_windows() const;
};

std::vector<const PreparedRecord*> prepared_records(const RecordSet& set);

/// The earliest time stamp of all records: the time origin of effects that change with time.
double first_stamp_s(const RecordSet& set);

/// Integrator steps for one pass of a model over the windows in use: one per sample, or more if masses oscillate within
/// a sample.
double steps_of(const sim::Drive& drive, const RecordSet& set);

/// Prepares records and computes their noise floors with `reference`, the best known model. Keeps references to the
/// records. If the measure is torque or force, only windows in which the axis slides throughout remain.
RecordSet compare_on(const std::vector<const Record*>& records, const sim::DriveDescription& reference,
                     double window_s = kWindow_s, Measure measure = Measure::motion);

/// The same windows with the motion as measure.
RecordSet by_motion(const RecordSet& set, const sim::DriveDescription& reference);

/// Recomputes the noise floors of the windows in use with a better model, and `common_square`. If most errors of
/// `reference` are far above their noise floors, as on a real machine, windows have full weight up to three times the
/// median error.
void renew_floors(RecordSet& set, const sim::DriveDescription& reference);

/// Mean over the windows and channels of (error/floor)^2 of one window.
struct WindowScore {
  std::size_t record;
  std::size_t window;
  double x = 0.0;  ///< mean squared error over squared noise floor; 0 if the record lacks the channel
  double w = 0.0;
  double effort = 0.0;  ///< the same for torque or force, if these are the measure

  /// Sum over all channels with their weights in a fit.
  double weighed(double common_square) const;
};

/// RMS errors of a model on a record set.
struct SetError {
  double combined = 0.0;  ///< RMS of error over noise floor, all windows and channels; about 1 if perfect
  double robust = 0.0;    ///< the same with less weight for outlying windows: the objective of a fit
  double x_rms = 0.0;     ///< mm or m
  double w_rms = 0.0;     ///< rad/s or m/s
  double x_floor = 0.0;   ///< RMS of the windows' noise floors
  double w_floor = 0.0;
  double effort_rms = 0.0;  ///< Nm or N, if torque or force is the measure; x and w are then zero
  double effort_floor = 0.0;
  /// Mean negative log-likelihood of the errors over all windows and channels, under a t distribution whose scale is
  /// the noise floor times a common factor of at least 1. Compares models by their own floors: a model that is
  /// uncertain of a motion gains by a large floor only where it errs as much. A constant in the unit of the channels is
  /// left out.
  double log_loss = 0.0;
  std::vector<double> window_log_loss;  ///< of each window, the sum over its channels
  std::vector<WindowScore> windows;
};

/// Squared error of a window over its squared noise floor, with its weight in a fit.
double weighed_square(double square, double common_square);

SetError error_of(const sim::Drive& drive, const RecordSet& set);

/// The same over the model's own noise floors.
SetError error_over_own_floors(const sim::DriveDescription& model, const RecordSet& set);

/// Number of measured channels of a record in this measure.
std::size_t channel_count(const ComparedRecord& compared, Measure measure);

/// Residuals (prediction - measurement)/noise floor of every used row, scaled so that the sum of their squares is
/// robust^2.
std::size_t residual_count(const RecordSet& set);
void residuals_of(const sim::Drive& drive, const RecordSet& set, double* out);

}  // namespace host
