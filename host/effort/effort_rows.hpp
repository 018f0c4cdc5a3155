// Rows for least squares: the motor's torque or force and the motion of the axis while it slides.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// The signals of one record at its own sample rate, low-passed without delay, and the selected rows.
struct EffortSignals {
  const Record* record = nullptr;  ///< must outlive this object
  double period_s = 0.0;
  double cutoff_Hz = 0.0;
  std::vector<double> speed;         ///< rad/s or m/s, every sample
  std::vector<double> acceleration;  ///< rad/s^2 or m/s^2, every sample
  std::vector<double> motion;        ///< travel (the speed, if there is no position), every sample
  std::vector<std::size_t> kept;     ///< samples that became rows, in order
  std::size_t first_row = 0;         ///< index of the first of these rows in EffortRows
};

/// The rows of all records in sequence, one element per row. Speeds in rad/s or m/s, travel in mm or m, torque or force
/// in Nm or N.
struct EffortRows {
  Eigen::VectorXd t_s, x, w, acceleration, effort;
  /// Change of the torque or force from one sample to the next, Nm or N. It is the effect of shifting the logged
  /// current by one sample. 0 in records whose time offset is known.
  Eigen::VectorXd effort_per_sample;
  std::vector<bool> judges;         ///< a row of the validation set
  std::vector<std::size_t> block;   ///< number of its block: half a second of one record, with correlated rows
  std::vector<std::size_t> record;  ///< number of its record, from 0; a record in both sets counts twice
  std::vector<EffortSignals> signals;
  bool by_speed = false;      ///< acceleration and speed are from the speed channel, which has less noise
  bool has_position = false;  ///< every record has a position
  bool steady = true;         ///< the speed hardly changes in any record, so the inertia cannot be identified
  double lowest_cutoff_Hz = 0.0;
  double lead = 1.0;              ///< travel of one radian, mm; 1 for a linear drive
  bool commanded = true;          ///< every record gives torque or force by its command, not by a measurement
  double timing_deviation = 0.0;  ///< standard deviation of the time offset of a logged current, samples; 0 if known
  double first_stamp_s = 0.0;     ///< earliest time of the training records
  double noise = 0.0;             ///< RMS torque or force due to sensor noise through the model's inertia, Nm or N

  std::size_t size() const { return judges.size(); }
};

/// Replaces the rows of each record by its mean speed per direction, without acceleration. Needed if the speed hardly
/// changes, because its small changes are then as much an effect of the torque as its cause.
void take_mean_speeds(EffortRows& rows);

/// Upper bound of the RMS residual that sensor noise alone leaves on the validation rows (`judges`) or on the training
/// rows: `noise` plus two standard deviations of an RMS of so many values.
double most_noise(const EffortRows& rows, bool judges);

/// RMS of one value per row, over the validation rows (`judges`) or the training rows.
double root_mean_square(const EffortRows& rows, const Eigen::VectorXd& values, bool judges);

/// Travel since the last reversal, mm or m (rad or m/s if there is no position), one element per row.
Eigen::VectorXd travel_since_reversal(const EffortRows& rows);

/// Rows of both sets, with the motion from the channel for which inertia and friction leave the smaller residual. Empty
/// if a record has no torque or force, or if either set has less than kLeastSliding_s of sliding. Thinned evenly to
/// `most_rows`, because more rows take time without adding information.
EffortRows effort_rows(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                       std::size_t most_rows = 12000);

/// Every `stride`-th row of each record.
struct ThinnedRows {
  EffortRows rows;
  std::vector<Eigen::Index> from;  ///< index of each row among all rows

  /// The same rows of a matrix with all rows.
  Eigen::MatrixXd of(const Eigen::MatrixXd& columns) const { return columns(from, Eigen::all); }
  /// Expands values of the kept rows to all rows: each row takes the value of the last kept row before it.
  Eigen::VectorXd spread(const Eigen::VectorXd& values, Eigen::Index all) const;
};
ThinnedRows thinned(const EffortRows& rows, std::size_t stride);

}  // namespace host
