// Figures of a comparison, of one model or of several on top of each other.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "host/compare/focus.hpp"
#include "host/compare/model_comparison.hpp"
#include "host/report/report.hpp"

namespace host {

/// A model, its prepared records, and its errors on them.
struct ComparedModel {
  std::string path;             ///< as the user named it
  sim::DriveDescription model;  ///< with_measured_sensors
  Measurements measured;
  RecordSet set;  ///< refers to `measured`
  ModelComparison comparison;

  std::string name() const;  ///< of the file
};

/// Admits the records as they were logged and compares the model, completed by their sensors, on windows of `window_s`.
/// Throws Failure(usage) for an invalid time, and what MeasurementGate, compare_on and compare_model throw.
ComparedModel compare_with(const std::string& path, const sim::DriveDescription& model, std::vector<Record> records,
                           double window_s, const std::vector<std::string>& accepted);

/// "axis-comparison/1" of the first model; of several, each in "models".
nlohmann::json comparison_document(std::span<const ComparedModel> models);

/// Roles with different colours, one per model; further models repeat them.
SeriesRole role_of_model(std::size_t index);

/// The record that the focus names. Throws Failure(usage) where there is no such record.
std::size_t record_in(const Focus& focus, const ModelComparison& comparison);

/// Measured and predicted rows of one record, and the errors.
TimePlot prediction_traces(std::span<const ComparedModel> models, std::size_t record,
                           const std::optional<TimeSpan>& stretch = {});

/// The torque or force that each model lacks, as add_residual_plots() draws it; of one model as a map, too.
void add_missing_effort(std::span<const ComparedModel> models, Report& report, const Focus& focus = {});

}  // namespace host
