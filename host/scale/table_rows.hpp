// Rows of what the table does against the motor: x2 - x, and the motion and force meanwhile.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "host/infer/evidence.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// One record at its own rate, mm and s. `effort` is empty where the record has none.
struct TableRecord {
  const Record* record = nullptr;  ///< outlives this
  std::vector<double> x;           ///< mm, of either kind of drive
  std::vector<double> effort;      ///< of the motor, Nm or N
  Eigen::Index first_row = 0, rows = 0;
  std::size_t stride = 1;      ///< samples of which one row is the mean
  std::vector<double> motor;   ///< mm, x between its counts
  std::vector<double> pusher;  ///< mm: where the motor is, without what is known of its encoder's error

  /// Means over each row's samples of a value at every sample.
  void put_means(const std::vector<double>& samples, Eigen::VectorXd& of_all_rows) const;
};

/// All records after one another; a row is the mean of a few samples.
struct TableRows {
  std::vector<TableRecord> records;
  Eigen::VectorXd y;       ///< x2 - x, um, about the first row of each record
  Eigen::VectorXd x;       ///< mm, of the motor's encoder
  Eigen::VectorXd v, a;    ///< mm/s, mm/s^2, of the pusher
  Eigen::VectorXd t_s;     ///< the record's own clock
  Eigen::VectorXd effort;  ///< Nm or N; empty unless all records have it
  Eigen::VectorXd temp_C;  ///< empty unless all records have it
  Eigen::VectorXd since;   ///< travel since the last reversal, mm
  Eigen::VectorXd way;     ///< direction of the last motion, -1 or 1
  std::vector<RowRun> runs;
  double step_um = 0.0;   ///< of both sensors together: the motor's as far as its smoothed travel is in doubt
  double noise_um = 0.0;  ///< of these steps in one row
  double late_s = 0.0;    ///< by which the table is known to be read after the motor

  Eigen::Index size() const { return y.size(); }
  /// Speed and acceleration anew, after the pusher has changed.
  void differentiate_pusher();
  bool has_effort() const { return effort.size() > 0; }
  /// Means over each row's samples of what `of` gives for every sample of a record.
  Eigen::VectorXd means(const std::function<std::vector<double>(const TableRecord&)>& of) const;
};

double rms(const Eigen::VectorXd& values);

/// Of those records that have both positions; empty where none has. Throws Failure(bad_input) where the drive's
/// constants are missing.
TableRows table_rows(const std::vector<const Record*>& records, const sim::DriveDescription& model);

}  // namespace host
