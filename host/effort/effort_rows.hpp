// Rows for least squares: the motor's torque or force, and the motion of the axis while it slides.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// One record's signals at its own rate, low-passed without delay, and the selected rows.
struct EffortSignals {
  const Record* record = nullptr;  ///< outlives these
  double period_s = 0.0;
  double cutoff_Hz = 0.0;
  std::vector<double> speed;         ///< rad/s or m/s, every sample
  std::vector<double> acceleration;  ///< rad/s^2 or m/s^2, every sample
  std::vector<double> motion;        ///< travel (the speed, if there is no position), every sample
  std::vector<std::size_t> kept;     ///< samples that became rows, in order
  std::size_t first_row = 0;         ///< of those, in EffortRows
};

/// All records one after the other; one element per row. Speeds in rad/s or m/s, travel in mm or m, effort in Nm or N.
struct EffortRows {
  Eigen::VectorXd t_s, x, w, acceleration, effort;
  /// Change of the torque or force from one sample to the next, Nm or N: the effect of a time offset of the logged
  /// current by one sample. 0 in records whose time offset is known.
  Eigen::VectorXd effort_per_sample;
  std::vector<bool> judges;         ///< a row of the validation set
  std::vector<std::size_t> block;   ///< half a second of one record, whose rows are correlated
  std::vector<std::size_t> record;  ///< ascending from 0; a record in both sets counts twice
  std::vector<EffortSignals> signals;
  bool by_speed = false;      ///< acceleration and speed are from the speed channel, which has less noise
  bool has_position = false;  ///< in every record
  bool steady = true;         ///< the speed hardly changes within the records, so that inertia cannot be identified
  double lowest_cutoff_Hz = 0.0;
  double lead = 1.0;              ///< travel of one radian, mm; 1 of a linear drive
  bool commanded = true;          ///< torque or force is known from the logged command in every record, not measured
  double timing_deviation = 0.0;  ///< of the time at which a logged current acts, samples; 0 if it is known
  double first_stamp_s = 0.0;     ///< of the training records
  double noise = 0.0;             ///< RMS torque or force due to sensor noise through the model's inertia, Nm or N

  std::size_t size() const { return judges.size(); }
};

/// If the speed hardly changes, its residual changes follow the torque as much as they cause it: each record has one
/// speed per direction, and no acceleration.
void take_mean_speeds(EffortRows& rows);

/// Upper bound of the RMS residual that sensor noise alone leaves on the validation rows, or on the training rows:
/// `noise` plus two standard deviations of an RMS of this many values.
double most_noise(const EffortRows& rows, bool judges);

/// RMS of one value per row, over validation rows or training rows.
double root_mean_square(const EffortRows& rows, const Eigen::VectorXd& values, bool judges);

/// Travel since the last reversal, mm or m (without a position rad or m/s), one element per row.
Eigen::VectorXd travel_since_reversal(const EffortRows& rows);

/// Rows of both sets, from the channel with the smaller residual of inertia and friction. Empty if a record has no
/// torque or force, or if either set has less than a second of sliding. Evenly thinned to `most_rows`: more add cost
/// and no information.
EffortRows effort_rows(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                       std::size_t most_rows = 12000);

/// Every `stride`-th row of each record.
struct ThinnedRows {
  EffortRows rows;
  std::vector<Eigen::Index> from;  ///< index of each row among all rows

  /// The same rows of a matrix with all rows.
  Eigen::MatrixXd of(const Eigen::MatrixXd& columns) const { return columns(from, Eigen::all); }
  /// Expands values of the kept rows to all rows: each takes the last kept row before it.
  Eigen::VectorXd spread(const Eigen::VectorXd& values, Eigen::Index all) const;
};
ThinnedRows thinned(const EffortRows& rows, std::size_t stride);

}  // namespace host
