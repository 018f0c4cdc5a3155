// Possible effects between motor and table, each as columns of x2 - x in um.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scale/driven_table.hpp"

namespace host {

/// One effect in one form. Its columns are linear in the fitted factors; nonlinear parameters are in the shape.
struct TableTerm {
  std::string kind;  ///< of the catalogue
  /// pitch_error: middle and length of the travel, mm; encoder_cyclic_error: period, mm; thermal_growth: time constant,
  /// s (0: by temp_C).
  std::vector<double> shape;
  TableDrive drive;           ///< of backlash and compliance; if both are present, they share it
  double deceleration = 0.0;  ///< of the whole drive: see shape_ranges()

  bool is_driven() const { return kind == "backlash" || kind == "compliance"; }

  /// Values at every row. The first column's factor is the effect's size, if it has one: gap um, um per mm/s^2, um per
  /// metre, um. Further columns of a driven table are corrections of its shape.
  Eigen::MatrixXd columns(const TableRows& rows) const;
  /// The same for intervals: effect of a change of the size, at this size.
  Eigen::MatrixXd slopes(const TableRows& rows) const;
  Eigen::Index count(const TableRows& rows) const;
  /// The same for a first look at many forms: assumes a uniform motion within each row.
  Eigen::MatrixXd quick_columns(const TableRows& rows) const;
  /// Prior scale of the factors, for a difference of `usual` um RMS.
  Eigen::VectorXd deviations(const Eigen::MatrixXd& columns, double usual) const;
  /// Required sign of the first column's factor; 0: either.
  int sign() const { return is_driven() ? 1 : 0; }
  /// Whether every record has factors of its own.
  bool is_of_the_record() const { return kind == "thermal_growth" && shape[0] > 0.0; }
};

/// Number of waves of a pitch curve over 1.25 times the travel: down to a tenth of it.
inline constexpr int kPitchOrders = 12;
inline constexpr double kPitchPeriod = 1.25;

/// All kinds, in the order of the catalogue.
inline constexpr std::string_view kTableKinds[] = {"compliance", "backlash", "encoder_cyclic_error", "pitch_error",
                                                   "thermal_growth"};

/// Forms of one kind that these rows may show; none for a driven table.
std::vector<TableTerm> table_forms(std::string_view kind, const TableRows& rows);

/// Starting points for the fit of a driven table: a grid over gap, spring and friction. `deceleration`: see
/// shape_ranges(). A gap or a spring that was found alone is no start, because its friction belongs to a table that
/// follows differently.
std::vector<TableDrive> drive_starts(bool gap, bool spring, const TableRows& rows, double deceleration);

/// Drives about this one: with a larger gap and less friction to bend the spring, or the reverse. All lose as much at a
/// reversal.
std::vector<TableDrive> drives_of_equal_loss(const TableDrive& drive);

/// Columns that are always present: each record's offset, and the delay between the two sensors.
Eigen::MatrixXd table_base(const TableRows& rows);

/// Memory: smooth functions of speed, position and travel since reversal by direction, and of the force.
Memory table_memory(const TableRows& rows, double usual);

}  // namespace host
