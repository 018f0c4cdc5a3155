// A table that the motor drives through a gap, a spring or both, against friction of its own.
//
//   table's acceleration = pull - deceleration sign(w) - drag w,   pull = bent / lag + 2 damping (bent)' / sqrt(lag)
//
// bent = what the motor is ahead of the table beyond half the gap; behind a gap the contact pushes and never pulls.
// All is measured against the table's own inertia, so the motor's motion alone says how the table follows.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "host/scale/table_rows.hpp"

namespace host {

struct TableDrive {
  double gap = 0.0;           ///< free travel, mm, >= 0
  double lag = 0.0;           ///< the spring's bend a unit of acceleration, s^2: 1 / (2 pi resonance)^2; 0: rigid
  double damping = 0.05;      ///< ratio, with the motor held
  double deceleration = 0.0;  ///< Coulomb friction over the table's inertia, mm/s^2
  double drag = 0.0;          ///< viscous friction over the table's inertia, 1/s
  double late_s = 0.0;        ///< by which the table is read after the motor, beyond what table_base() takes
};

/// What a fit moves: natural logarithms of gap, lag, deceleration and damping, drag in 1/s, late in ms.
enum class DriveNumber { gap, lag, deceleration, damping, drag, late };

struct DriveRange {
  DriveNumber which;
  double low, high;
  double step;       ///< for differences: as much as shows above the encoders' steps
  double middle;     ///< before the measurement
  double deviation;  ///< of that; a drive's own share of friction and inertia, usual contacts
};

double number_of(const TableDrive& drive, DriveNumber which);
void set_number(TableDrive& drive, DriveNumber which, double value);

/// Those that say how the table follows beside the sizes of gap and spring. `deceleration`: of the whole drive left to
/// its own friction, mm/s^2; 0 where it is not known.
std::vector<DriveRange> shape_ranges(const TableDrive& drive, double deceleration);

/// Twice the negative logarithm of how probable these numbers are before the measurement, less its least.
double prior_cost(const TableDrive& drive, const std::vector<DriveRange>& numbers);

/// Of every row, as means over its samples.
struct DrivenRows {
  Eigen::VectorXd gap;   ///< the table's travel in the gap less the motor's, over the gap: -1/2 to 1/2
  Eigen::VectorXd pull;  ///< -bent / lag, mm/s^2
  Eigen::VectorXd all;   ///< the table's travel less the motor's, um
};

/// The motor's end moves as `TableRecord::pusher` says; each record begins with the spring unbent in the gap's middle.
/// Drives are simulated side by side: all with a spring or all without one. At least one.
std::vector<DrivenRows> drive_tables(std::span<const TableDrive> drives, const TableRows& rows);

}  // namespace host
