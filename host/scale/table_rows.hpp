// Rows of the table's motion relative to the motor: x2 - x, with motion and force.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "host/infer/evidence.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// One record at its own sample rate, mm and s. `effort` is empty if the record has none.
struct TableRecord {
  const Record* record = nullptr;  ///< must outlive this object
  std::vector<double> x;           ///< mm, for both kinds of drive
  std::vector<double> effort;      ///< torque or force of the motor, Nm or N
  Eigen::Index first_row = 0, rows = 0;
  std::size_t stride = 1;      ///< number of samples per row
  std::vector<double> motor;   ///< mm, x interpolated between its counts
  std::vector<double> pusher;  ///< mm: true position of the motor, corrected for the known error of its encoder

  /// Writes the means of a sampled value over the samples of each row.
  void put_means(const std::vector<double>& samples, Eigen::VectorXd& of_all_rows) const;
};

/// All records in sequence; a row is the mean of a few samples.
struct TableRows {
  std::vector<TableRecord> records;
  Eigen::VectorXd y;       ///< x2 - x relative to the first row of each record, um
  Eigen::VectorXd x;       ///< position of the motor's encoder, mm
  Eigen::VectorXd v, a;    ///< speed and acceleration of the pusher, mm/s, mm/s^2
  Eigen::VectorXd t_s;     ///< time stamps of the record
  Eigen::VectorXd effort;  ///< Nm or N; empty if a record has none
  Eigen::VectorXd temp_C;  ///< empty if a record has none
  Eigen::VectorXd since;   ///< travel since the last reversal, mm
  Eigen::VectorXd way;     ///< direction of the last motion, -1 or 1
  std::vector<RowRun> runs;
  double step_um = 0.0;   ///< step of the table's sensor and uncertainty of the motor's smoothed travel
  double noise_um = 0.0;  ///< noise of one row due to step_um
  double late_s = 0.0;    ///< known delay of the table's reading after the motor's

  Eigen::Index size() const { return y.size(); }
  /// Recomputes speed and acceleration after a change of the pusher.
  void differentiate_pusher();
  bool has_effort() const { return effort.size() > 0; }
  /// Means over the samples of each row of the values that `of` returns for every sample of a record.
  Eigen::VectorXd means(const std::function<std::vector<double>(const TableRecord&)>& of) const;
};

double rms(const Eigen::VectorXd& values);

/// Rows of the records with both positions; empty if no record has them. Throws Failure(bad_input) if constants of the
/// drive are missing.
TableRows table_rows(const std::vector<const Record*>& records, const sim::DriveDescription& model);

}  // namespace host
