// A table that the motor drives through a gap, a spring or both, against friction of its own.
//
//   table's acceleration = pull - deceleration sign(w) - drag w,   pull = bent / lag + 2 damping (bent)' / sqrt(lag)
//
// bent = distance by which the motor is ahead of the table, beyond half the gap. With a gap, the contact pushes and
// never pulls. All forces are divided by the inertia of the table, so the motion of the motor alone determines how the
// table follows.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "host/scale/table_rows.hpp"

namespace host {

struct TableDrive {
  double gap = 0.0;           ///< free travel, mm, >= 0
  double lag = 0.0;           ///< deflection of the spring per acceleration, s^2: 1 / (2 pi resonance)^2; 0: rigid
  double damping = 0.05;      ///< damping ratio with the motor held
  double deceleration = 0.0;  ///< Coulomb friction over the table's inertia, mm/s^2
  double drag = 0.0;          ///< viscous friction over the table's inertia, 1/s
  double late_s = 0.0;        ///< delay of the table's reading after the motor's, beyond that in table_base()
};

/// Parameters of a fit: natural logarithms of gap, lag, deceleration and damping; drag in 1/s; late in ms.
enum class DriveNumber { gap, lag, deceleration, damping, drag, late };

struct DriveRange {
  DriveNumber which;
  double low, high;
  double step;       ///< difference step, large enough to exceed the encoders' steps
  double middle;     ///< prior mean
  double deviation;  ///< prior standard deviation, from usual shares of friction and inertia and usual contacts
};

double number_of(const TableDrive& drive, DriveNumber which);
void set_number(TableDrive& drive, DriveNumber which, double value);

/// Ranges of the parameters other than the sizes of gap and spring. `deceleration`: of the whole drive by its friction,
/// mm/s^2; 0 if unknown.
std::vector<DriveRange> shape_ranges(const TableDrive& drive, double deceleration);

/// Twice the negative logarithm of the prior probability of these numbers, minus its smallest value.
double prior_cost(const TableDrive& drive, const std::vector<DriveRange>& numbers);

/// Values for every row, as means over its samples.
struct DrivenRows {
  Eigen::VectorXd gap;   ///< the table's travel minus the motor's within the gap, over the gap: -1/2 to 1/2
  Eigen::VectorXd pull;  ///< -bent / lag, mm/s^2
  Eigen::VectorXd all;   ///< the table's travel minus the motor's, um
};

/// The motor end follows `TableRecord::pusher`. Each record begins with the spring relaxed in the middle of the gap.
/// Tables are simulated in parallel: either all have a spring or none has. Needs at least one.
std::vector<DrivenRows> drive_tables(std::span<const TableDrive> drives, const TableRows& rows);

}  // namespace host
