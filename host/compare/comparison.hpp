// Records and noise floors for comparing models, and the error measure.
#pragma once

#include <memory>
#include <vector>

#include "host/compare/effort_prediction.hpp"
#include "host/compare/error_floor.hpp"
#include "host/compare/prediction.hpp"

namespace host {

/// Measure of comparison.
enum class Measure {
  motion,  ///< predicted against measured travel and speed
  effort   ///< inverse model's torque or force against the motor's; for drives with an inverse
};

/// A record with the floor of each of its windows.
struct ComparedRecord {
  PreparedRecord prepared;
  ErrorFloor floor;
  std::shared_ptr<const EffortRecord> effort = nullptr;  ///< if the measure is torque or force
};

/// Three floors: a single late impact or breakaway must not outweigh all windows that fit.
inline constexpr double kCommonSquare = 9.0;

/// The records of one purpose (training, or validation).
struct RecordSet {
  std::vector<ComparedRecord> records;
  Measure measure = Measure::motion;
  std::size_t stride = 1;  ///< uses every stride-th window; more than 1 makes a search faster
  /// Squared error over floor squared up to which a window counts in full in a fit; beyond, its weight grows as the
  /// logarithm. At least three floors.
  double common_square = kCommonSquare;

  std::size_t used_windows() const;
};

std::vector<const PreparedRecord*> prepared_records(const RecordSet& set);

/// The earliest time stamp of all: time origin of effects that change with time, whatever the logger's clock.
double first_stamp_s(const RecordSet& set);

/// Integrator steps of one pass of a model over the windows in use: one per sample, more if masses oscillate within a
/// sample.
double steps_of(const sim::Drive& drive, const RecordSet& set);

/// Prepares records and computes their floors with `reference`, the best model known. Keeps references to the records.
/// If torque or force is the measure, only windows remain in which the axis slides throughout.
RecordSet compare_on(const std::vector<const Record*>& records, const sim::DriveDescription& reference,
                     double window_s = kWindow_s, Measure measure = Measure::motion);

/// The same windows, compared by their motion.
RecordSet by_motion(const RecordSet& set, const sim::DriveDescription& reference);

/// Recomputes the floors of the windows in use with a better model, and the common error: if most windows of
/// `reference` lie far above their floors, as on a real machine, three times their median error counts as common.
void renew_floors(RecordSet& set, const sim::DriveDescription& reference);

/// Mean over the windows and channels of (error/floor)^2 of one window.
struct WindowScore {
  std::size_t record;
  std::size_t window;
  double x = 0.0;  ///< mean squared error of the channel over its floor squared; 0 where the record lacks it
  double w = 0.0;
  double effort = 0.0;  ///< the same for torque or force, if that is the measure

  /// Sum over all channels, each with its weight in a fit.
  double weighed(double common_square) const;
};

/// RMS errors of a model on a record set.
struct SetError {
  double combined = 0.0;  ///< RMS over windows and channels of error/floor; about 1 for a perfect model
  double robust = 0.0;    ///< the same with outlying windows weighted by the logarithm: the objective of a fit
  double x_rms = 0.0;     ///< mm or m
  double w_rms = 0.0;     ///< rad/s or m/s
  double x_floor = 0.0;   ///< RMS of the windows' floors
  double w_floor = 0.0;
  double effort_rms = 0.0;  ///< Nm or N, if torque or force is the measure; then the others are zero
  double effort_floor = 0.0;
  std::vector<WindowScore> windows;
};

/// Squared error of a window over its squared noise floor, with its weight in a fit.
double weighed_square(double square, double common_square);

SetError error_of(const sim::Drive& drive, const RecordSet& set);

/// Measured channels of a record in this measure.
std::size_t channel_count(const ComparedRecord& compared, Measure measure);

/// Residuals (prediction - measurement)/floor of every used row, scaled so that their squares sum to robust^2.
std::size_t residual_count(const RecordSet& set);
void residuals_of(const sim::Drive& drive, const RecordSet& set, double* out);

}  // namespace host
