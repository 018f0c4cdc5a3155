// What may stand between motor and table, each as columns of x2 - x in um.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scale/table_rows.hpp"

namespace host {

/// Entries of a gap's shape where no spring stands beside it.
inline constexpr std::size_t kPlainGap = 2;

/// One effect in one form. Its columns are linear in what is fitted; what is not linear stands in the shape.
struct TableTerm {
  std::string kind;  ///< of the catalogue
  /// backlash: gap mm, deceleration of a table that slides free in the gap, mm/s^2 (infinite: it stays where it is),
  /// then, beside a spring, the shape and the factors of its compliance, in the order of its columns;
  /// compliance: inertia that the second column is of, Nm or N per mm/s^2; pitch_error: middle and length of the
  /// travel, mm; encoder_cyclic_error: period, mm; thermal_growth: time constant, s (0: by temp_C).
  std::vector<double> shape;

  /// One row each; the first column's factor is the effect's size where it has one: gap um, um a Nm or N, um a metre,
  /// um.
  Eigen::MatrixXd columns(const TableRows& rows) const;
  /// The same for a first look at many forms: as if each row's motion were even.
  Eigen::MatrixXd quick_columns(const TableRows& rows) const;
  /// What the factors compare to before the measurement, for a difference of `usual` um RMS.
  Eigen::VectorXd deviations(const Eigen::MatrixXd& columns, double usual) const;
  /// A factor of this sign alone makes sense for the first column; 0: either.
  int sign() const { return kind == "backlash" || kind == "compliance" ? 1 : 0; }
  /// Whether every record has factors of its own.
  bool is_of_the_record() const { return kind == "thermal_growth" && shape[0] > 0.0; }
};

/// Waves that a pitch curve consists of, over 1.25 times the travel: down to a tenth of it.
inline constexpr int kPitchOrders = 12;
inline constexpr double kPitchPeriod = 1.25;

/// All kinds, in the order of the catalogue.
inline constexpr std::string_view kTableKinds[] = {"compliance", "backlash", "encoder_cyclic_error", "pitch_error",
                                                   "thermal_growth"};

/// Forms of one kind that these rows may show. `inertia`: of the drive, Nm or N per mm/s^2, 0 where it is not known;
/// `deceleration`: of a drive left to its own friction, mm/s^2, 0 where it is not known.
std::vector<TableTerm> table_forms(std::string_view kind, const TableRows& rows, double inertia, double deceleration);

/// Always there: each record's offset, and the time by which one sensor is read after the other.
Eigen::MatrixXd table_base(const TableRows& rows);

/// Smooth functions of speed, position and travel since reversal by direction, and of the force.
Memory table_memory(const TableRows& rows, double usual);

}  // namespace host
