// What may stand between motor and table, each as columns of x2 - x in um.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scale/driven_table.hpp"

namespace host {

/// One effect in one form. Its columns are linear in what is fitted; what is not linear stands in the shape.
struct TableTerm {
  std::string kind;  ///< of the catalogue
  /// pitch_error: middle and length of the travel, mm; encoder_cyclic_error: period, mm; thermal_growth: time constant,
  /// s (0: by temp_C).
  std::vector<double> shape;
  TableDrive drive;           ///< of backlash and compliance; beside each other both have the same
  double deceleration = 0.0;  ///< of the whole drive: see shape_ranges()

  bool is_driven() const { return kind == "backlash" || kind == "compliance"; }

  /// One row each; the first column's factor is the effect's size where it has one: gap um, um a mm/s^2, um a metre,
  /// um. Further columns of what is driven are what its shape may still be off.
  Eigen::MatrixXd columns(const TableRows& rows) const;
  /// The same for intervals: what a change of the size does, at this size.
  Eigen::MatrixXd slopes(const TableRows& rows) const;
  Eigen::Index count(const TableRows& rows) const;
  /// The same for a first look at many forms: as if each row's motion were even.
  Eigen::MatrixXd quick_columns(const TableRows& rows) const;
  /// What the factors compare to before the measurement, for a difference of `usual` um RMS.
  Eigen::VectorXd deviations(const Eigen::MatrixXd& columns, double usual) const;
  /// A factor of this sign alone makes sense for the first column; 0: either.
  int sign() const { return is_driven() ? 1 : 0; }
  /// Whether every record has factors of its own.
  bool is_of_the_record() const { return kind == "thermal_growth" && shape[0] > 0.0; }
};

/// Waves that a pitch curve consists of, over 1.25 times the travel: down to a tenth of it.
inline constexpr int kPitchOrders = 12;
inline constexpr double kPitchPeriod = 1.25;

/// All kinds, in the order of the catalogue.
inline constexpr std::string_view kTableKinds[] = {"compliance", "backlash", "encoder_cyclic_error", "pitch_error",
                                                   "thermal_growth"};

/// Forms of one kind that these rows may show; none of what is driven.
std::vector<TableTerm> table_forms(std::string_view kind, const TableRows& rows);

/// Where the fit of a driven table may begin: a grid over gap, spring and friction. `deceleration`: see shape_ranges().
/// A gap or a spring that was found alone is no start: its friction is that of a table which follows otherwise.
std::vector<TableDrive> drive_starts(bool gap, bool spring, const TableRows& rows, double deceleration);

/// About this one: a larger gap and less friction to bend the spring, or the reverse. At a reversal all lose as much.
std::vector<TableDrive> drives_of_equal_loss(const TableDrive& drive);

/// Always there: each record's offset, and the time by which one sensor is read after the other.
Eigen::MatrixXd table_base(const TableRows& rows);

/// Smooth functions of speed, position and travel since reversal by direction, and of the force.
Memory table_memory(const TableRows& rows, double usual);

}  // namespace host
