// A model held against measurements: how far off, in which channel, where, and whether the log itself is sound.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/compare/error_regions.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/record/measurements.hpp"

namespace host {

struct ChannelComparison {
  std::string name;  ///< column in the drive's own units: x_mm, w_rad_s, x_m, v_m_s
  std::string unit;
  double rms = 0.0;          ///< of the prediction error
  double fit_percent = 0.0;  ///< 100 (1 - |error| / |measured - mean|); 100 is perfect, 0 as good as the mean
  double floor = 0.0;        ///< RMS that the best possible model would leave
};

struct RecordError {
  std::string path;
  std::vector<ChannelComparison> channels;
  double combined = 0.0;                 ///< RMS of error/floor over windows and channels; about 1 for a perfect model
  std::optional<double> relative_error;  ///< of the inverse model; empty where the axis never slides
  std::optional<double> free_run;        ///< RMS position error of a run to the end by the command alone, mm or m
};

struct ModelComparison {
  double window_s = kWindow_s;
  std::vector<ChannelComparison> channels;  ///< all records together
  double combined = 0.0;
  std::optional<double> relative_error;
  std::vector<RecordError> records;
  std::vector<ErrorRegion> where;
  std::vector<LogFault> log_faults;
};

/// Compares on a set made of the training records with `compare_on`; `model` has its sensors (with_measured_sensors).
ModelComparison compare_model(const sim::DriveDescription& model, const Measurements& measured, const RecordSet& set,
                              double window_s);

/// Prediction of every row: the rows after the last whole window by a shorter one, row 0 as the restart state reads.
Prediction predict_all_rows(const sim::DriveDescription& model, PreparedRecord prepared);

/// t_s, the record's own speed and position columns, x_pred_mm and w_pred_rad_s (x_pred_m, v_pred_m_s).
std::vector<std::pair<std::string, std::vector<double>>> predicted_columns(const sim::DriveDescription& model,
                                                                           const PreparedRecord& prepared);

/// The same as CSV; every number reads back as the same double.
std::string predictions_csv(const sim::DriveDescription& model, const PreparedRecord& prepared);

/// "axis-comparison/1".
nlohmann::json comparison_json(const ModelComparison& comparison);

}  // namespace host
