// Figures of a comparison of one or several models with records.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "host/compare/focus.hpp"
#include "host/compare/model_comparison.hpp"
#include "host/report/report.hpp"
#include "host/share_done.hpp"

namespace host {

/// A model, its prepared records, and its errors on them.
struct ComparedModel {
  std::string path;             ///< as the user named it
  sim::DriveDescription model;  ///< with_measured_sensors
  Measurements measured;
  RecordSet set;  ///< refers to records of `measured`
  ModelComparison comparison;

  std::string name() const;  ///< file name
};

/// Checks the records as logged and compares the model with them on windows of `window_s`. Missing sensor properties of
/// the model come from the records. Throws Failure(usage) for an invalid time, and what MeasurementGate, compare_on and
/// compare_model throw.
ComparedModel compare_with(const std::string& path, const sim::DriveDescription& model, std::vector<Record> records,
                           double window_s, const std::vector<std::string>& accepted, const ShareDone& progress = {});

/// "axis-comparison/1" of one model; for several models, one per element of "models".
nlohmann::json comparison_document(std::span<const ComparedModel> models);

/// Series roles with different colours for the models; they repeat if there are many models.
SeriesRole role_of_model(std::size_t index);

/// Index of the record named in the focus. Throws Failure(usage) if there is no such record.
std::size_t record_in(const Focus& focus, const ModelComparison& comparison);

/// Measured and predicted rows of one record, and their difference.
TimePlot prediction_traces(std::span<const ComparedModel> models, std::size_t record,
                           const std::optional<TimeSpan>& stretch = {});

/// The torque or force that is missing in each model, as add_residual_plots() draws it; for a single model also as a
/// map.
void add_missing_effort(std::span<const ComparedModel> models, Report& report, const Focus& focus = {});

}  // namespace host
