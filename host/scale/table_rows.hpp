// Rows of the table's motion relative to the motor: x2 - x, with motion and force.
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
  std::vector<double> motor;   ///< mm, x interpolated between its counts
  std::vector<double> pusher;  ///< mm: true position of the motor, corrected for the known error of its encoder

  /// Means of a sampled value over each row's samples.
  void put_means(const std::vector<double>& samples, Eigen::VectorXd& of_all_rows) const;
};

/// All records one after the other; a row is the mean of a few samples.
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
  double step_um = 0.0;   ///< of both sensors together; of the motor's only the uncertainty of its smoothed travel
  double noise_um = 0.0;  ///< caused by these steps in one row
  double late_s = 0.0;    ///< by which the table is known to be read after the motor

  Eigen::Index size() const { return y.size(); }
  /// Recomputes speed and acceleration after a change of the pusher.
  void differentiate_pusher();
  bool has_effort() const { return effort.size() > 0; }
  /// Means over each row's samples of the values of `of` for every sample of a record.
  Eigen::VectorXd means(const std::function<std::vector<double>(const TableRecord&)>& of) const;
};

double rms(const Eigen::VectorXd& values);

/// Rows of the records that have both positions; empty if none has. Throws Failure(bad_input) if the drive's constants
/// are missing.
TableRows table_rows(const std::vector<const Record*>& records, const sim::DriveDescription& model);

}  // namespace host
