// Compares a model with measurements: size, channel and region of the error, and faults of the log.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/compare/error_figures.hpp"
#include "host/compare/error_regions.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/record/measurements.hpp"
#include "host/scale/table_study.hpp"

namespace host {

struct RecordError {
  std::string path;
  ErrorFigures error;
  std::optional<double> relative_error;  ///< relative error of the inverse model; empty if the axis never slides
  std::optional<double> free_run;  ///< RMS position error of a run from the command alone to the record's end, mm or m
};

struct ModelComparison {
  ErrorFigures error;  ///< error of all records together
  std::optional<double> relative_error;
  std::vector<RecordError> records;
  /// Effects beyond inertia, viscous and Coulomb friction, and the factor by which `error.combined` grows without them
  /// (without a new fit); 1 if there are none.
  std::vector<std::string> effects;
  double without_effects = 1.0;
  std::vector<ErrorRegion> where;
  std::vector<LogFault> log_faults;
  TableStudy table;  ///< of all records together; empty if there is no sensor on the table
};

/// Compares on the figure_set() of the training records. `model` includes its sensors (with_measured_sensors).
ModelComparison compare_model(const sim::DriveDescription& model, const Measurements& measured, const RecordSet& set);

/// Prediction of every row. A shorter window covers the rows after the last whole one; row 0 has the restart state.
Prediction predict_all_rows(const sim::DriveDescription& model, PreparedRecord prepared);

/// t_s, the record's own speed and position columns, x_pred_mm and w_pred_rad_s (x_pred_m, v_pred_m_s). If the record
/// has the position of the table, also that and x2_pred_mm (x2_pred_m), which starts at the first reading of the
/// table's sensor.
std::vector<std::pair<std::string, std::vector<double>>> predicted_columns(const sim::DriveDescription& model,
                                                                           const PreparedRecord& prepared);

/// The same as CSV, with all digits that a double needs.
std::string predictions_csv(const sim::DriveDescription& model, const PreparedRecord& prepared);

/// "axis-comparison/1".
nlohmann::json comparison_json(const ModelComparison& comparison);

}  // namespace host
