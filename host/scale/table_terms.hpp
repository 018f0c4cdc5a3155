// Possible effects between motor and table, each as columns of x2 - x in um.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scale/driven_table.hpp"

namespace host {

/// One effect in one form. Its columns are linear in the fitted factors; the shape contains the nonlinear parameters.
struct TableTerm {
  std::string kind;  ///< kind in the catalogue
  /// pitch_error: middle and length of the travel, mm; encoder_cyclic_error: period, mm; thermal_growth: time constant,
  /// s (0: by temp_C).
  std::vector<double> shape;
  TableDrive drive;           ///< for backlash and compliance; if both are present, they share it
  double deceleration = 0.0;  ///< of the whole drive, see shape_ranges()

  bool is_driven() const { return kind == "backlash" || kind == "compliance"; }

  /// Values at every row. If the effect has a size, it is the factor of the first column: gap in um, um per mm/s^2, um
  /// per metre, um. Further columns of a driven table are corrections of its shape.
  Eigen::MatrixXd columns(const TableRows& rows) const;
  /// The same for intervals: the change of x2 - x by a change of the size, at this size.
  Eigen::MatrixXd slopes(const TableRows& rows) const;
  Eigen::Index count(const TableRows& rows) const;
  /// The same for a first look at many forms. Assumes a uniform motion within each row.
  Eigen::MatrixXd quick_columns(const TableRows& rows) const;
  /// Prior scale of the factors, for an RMS difference of `usual` um.
  Eigen::VectorXd deviations(const Eigen::MatrixXd& columns, double usual) const;
  /// Required sign of the first column's factor; 0 if both are allowed.
  int sign() const { return is_driven() ? 1 : 0; }
  /// Whether every record has its own factors.
  bool is_of_the_record() const { return kind == "thermal_growth" && shape[0] > 0.0; }
};

/// Number of waves of a pitch curve over 1.25 times the travel. The shortest is about a tenth of the travel.
inline constexpr int kPitchOrders = 12;
inline constexpr double kPitchPeriod = 1.25;

/// All kinds, in the order of the catalogue.
inline constexpr std::string_view kTableKinds[] = {"compliance", "backlash", "encoder_cyclic_error", "pitch_error",
                                                   "thermal_growth"};

/// Forms of one kind that these rows may show; empty for a driven table.
std::vector<TableTerm> table_forms(std::string_view kind, const TableRows& rows);

/// Start values for the fit of a driven table: a grid over gap, spring and friction. `deceleration`: see
/// shape_ranges(). A gap or a spring that was found alone is not used as a start, because its friction belongs to a
/// table that follows differently.
std::vector<TableDrive> drive_starts(bool gap, bool spring, const TableRows& rows, double deceleration);

/// Drives similar to this one, with a larger gap and less friction to deflect the spring, or the reverse. All have the
/// same lost motion at a reversal.
std::vector<TableDrive> drives_of_equal_loss(const TableDrive& drive);

/// Columns that are always present: the offset of each record, and the delay between the two sensors.
Eigen::MatrixXd table_base(const TableRows& rows);

/// Memory: smooth functions of speed, position and travel since the last reversal by direction, and of the force.
Memory table_memory(const TableRows& rows, double usual);

}  // namespace host
