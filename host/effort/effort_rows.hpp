// Rows for least squares: the motor's torque or force, and the motion of the axis while it slides.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// One record's signals at its own rate, low-passed without delay, and the rows of them that count.
struct EffortSignals {
  const Record* record = nullptr;  ///< outlives these
  double period_s = 0.0;
  double cutoff_Hz = 0.0;
  std::vector<double> speed;         ///< rad/s or m/s, every sample
  std::vector<double> acceleration;  ///< rad/s^2 or m/s^2, every sample
  std::vector<double> motion;        ///< travel, without a position the speed, at every sample
  std::vector<std::size_t> kept;     ///< samples that became rows, in order
  std::size_t first_row = 0;         ///< of those, in EffortRows
};

/// All records after one another; one element a row. Speeds in rad/s or m/s, travel in mm or m, effort in Nm or N.
struct EffortRows {
  Eigen::VectorXd t_s, x, w, acceleration, effort;
  std::vector<bool> judges;         ///< a row of the validation set
  std::vector<std::size_t> block;   ///< rows of one block are half a second of one record, and alike
  std::vector<std::size_t> record;  ///< rising from 0; a record that serves both sets counts twice
  std::vector<EffortSignals> signals;
  bool by_speed = false;      ///< acceleration and speed come from the speed channel, which was the cleaner one
  bool has_position = false;  ///< in every record
  bool steady = true;         ///< the speed hardly changes within the records: no inertia can be found from them
  double lowest_cutoff_Hz = 0.0;
  double lead = 1.0;  ///< travel of one radian, mm; 1 of a linear drive
  /// The longest period of the records whose effort was measured: nobody knows when within a row a current acts. A
  /// command is known to act from its row on.
  double unknown_instant_s = 0.0;
  double first_stamp_s = 0.0;  ///< of the training records
  double noise = 0.0;          ///< RMS effort that the sensor's own noise makes through the model's inertia, Nm or N

  std::size_t size() const { return judges.size(); }
};

/// Of one value a row, over the rows that judge or those that train.
double root_mean_square(const EffortRows& rows, const Eigen::VectorXd& values, bool judges);

/// Travel since the motion last reversed, mm or m (rad or m/s where there is no position), one element a row.
Eigen::VectorXd travel_since_reversal(const EffortRows& rows);

/// Rows of both sets, from the channel that leaves less of the effort unexplained by inertia and friction. Empty where
/// a record has no effort, or nothing slides for a second in either set. Evenly thinned to `most_rows`: more say
/// nothing new and cost time.
EffortRows effort_rows(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                       std::size_t most_rows = 12000);

/// Every `stride`-th row of each record.
struct ThinnedRows {
  EffortRows rows;
  std::vector<Eigen::Index> from;  ///< of each row, which one it was

  /// The same rows of columns over all.
  Eigen::MatrixXd of(const Eigen::MatrixXd& columns) const { return columns(from, Eigen::all); }
  /// A value for each of all rows: of the last one before it that was kept.
  Eigen::VectorXd spread(const Eigen::VectorXd& values, Eigen::Index all) const;
};
ThinnedRows thinned(const EffortRows& rows, std::size_t stride);

}  // namespace host
