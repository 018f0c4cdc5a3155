#include "host/compare/model_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/compare/free_run.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/record/columns.hpp"

namespace host {

namespace {

constexpr std::string_view kBaseKinds[] = {"inertia", "viscous", "coulomb"};

/// Empty if the records do not determine it, because the axis never slides or a record is too short for the filter.
std::optional<double> inverse_error(const sim::DriveDescription& model, const std::vector<Record>& records) {
  try {
    return relative_error(model, records);
  } catch (const Failure&) {
    return {};
  }
}

nlohmann::json channels_json(const ErrorFigures& figures) {
  nlohmann::json object = nlohmann::json::object();
  for (const ChannelFigures& channel : figures.channels)
    object[channel.name] = {{"rms", channel.rms}, {"fit", channel.fit_percent}, {"floor", channel.floor}};
  return object;
}

nlohmann::json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

/// Factor from the unit of a channel to that of the file: 1000 if the file has mm and the drive m.
double factor_in_file(const Record& record, std::vector<double> Record::*channel) {
  const KnownColumn* column = find_known_column(name_in_file(record, channel));
  const bool rotary = record.kind == sim::DriveKind::rotary;
  if (column == nullptr || column->unit == ColumnUnit::as_is) return 1.0;
  if (column->unit == ColumnUnit::m) return rotary ? 1e-3 : 1.0;
  return rotary ? 1.0 : 1e3;
}

/// Reading of the table's sensor. Its zero comes from the record, because the model does not contain it.
std::vector<double> readings_of(std::vector<double> table, const Record& record, const sim::DataSheet& data) {
  double zero = 0.0;
  for (std::size_t k = 0; k < table.size(); ++k) {
    table[k] += data.load_encoder_error(table[k], warmer_K(record, k));
    zero += (record.x2[k] - table[k]) / static_cast<double>(table.size());
  }
  for (double& reading : table) reading += zero;
  return table;
}

}  // namespace

ModelComparison compare_model(const sim::DriveDescription& model, const Measurements& measured, const RecordSet& set) {
  const std::vector<Record>& records = measured.training();
  ModelComparison comparison;
  const SetError error = error_of(sim::Drive(model), set);
  comparison.error = figures_of(error, set);
  for (std::size_t r = 0; r < set.records.size(); ++r)
    comparison.records.push_back({records[r].path, figures_of(error, set, r), inverse_error(model, {records[r]}),
                                  free_run_rms(model, set.records[r].prepared)});
  sim::DriveDescription base = model;
  std::erase_if(base.effects, [&](const sim::EffectEntry& entry) {
    const bool beyond = std::ranges::find(kBaseKinds, entry.kind) == std::end(kBaseKinds);
    if (beyond) comparison.effects.push_back(entry.kind);
    return beyond;
  });
  if (!comparison.effects.empty() && comparison.error.combined > 0.0)
    comparison.without_effects = error_of(sim::Drive(base), set).combined / comparison.error.combined;
  comparison.log_faults = measured.log();
  comparison.relative_error = inverse_error(model, records);
  comparison.where = error_regions(model, set);
  comparison.table = study_table(model, measured.training_records());
  return comparison;
}

Prediction predict_all_rows(const sim::DriveDescription& model, PreparedRecord prepared) {
  const sim::Drive drive(model);
  const std::size_t end = prepared.windows.back().begin + prepared.windows.back().length;
  if (end + 1 < prepared.record->size()) {
    prepared.windows.push_back({end, prepared.record->size() - 1 - end});
    auto weights = *prepared.shift_weights;
    if (end / prepared.windows.front().length == weights.size())
      weights.push_back(prepared.smoother->shift_weights(end));
    prepared.shift_weights = std::make_shared<const std::vector<ShiftWeights>>(std::move(weights));
  }
  Prediction prediction;
  predict(drive, prepared, prediction);
  const sim::DriveState start = restart_states(drive, prepared).front();
  prediction.x.front() = drive.encoder(start);
  prediction.w.front() = drive.tachometer(start);
  if (!prediction.table.empty()) prediction.table.front() = drive.table(start, prepared.record->t_s.front());
  return prediction;
}

std::vector<std::pair<std::string, std::vector<double>>> predicted_columns(const sim::DriveDescription& model,
                                                                           const PreparedRecord& prepared) {
  const Record& record = *prepared.record;
  Prediction prediction = predict_all_rows(model, prepared);
  std::vector<std::pair<std::string, std::vector<double>>> columns{{"t_s", record.t_s}};
  for (const auto channel : {&Record::w, &Record::x, &Record::x2}) {
    if ((record.*channel).empty()) continue;
    columns.emplace_back(name_in_file(record, channel), record.*channel);
    for (double& value : columns.back().second) value *= factor_in_file(record, channel);
  }
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  columns.emplace_back(rotary ? "x_pred_mm" : "x_pred_m", std::move(prediction.x));
  columns.emplace_back(rotary ? "w_pred_rad_s" : "v_pred_m_s", std::move(prediction.w));
  if (!prediction.table.empty())
    columns.emplace_back(rotary ? "x2_pred_mm" : "x2_pred_m", readings_of(prediction.table, record, model.data));
  return columns;
}

std::string predictions_csv(const sim::DriveDescription& model, const PreparedRecord& prepared) {
  const auto columns = predicted_columns(model, prepared);
  std::string text;
  for (const auto& column : columns) text += (text.empty() ? "" : ",") + column.first;
  text += '\n';
  for (std::size_t row = 0; row < prepared.record->size(); ++row) {
    for (const auto& column : columns) fmt::format_to(std::back_inserter(text), "{},", column.second[row]);
    text.back() = '\n';
  }
  return text;
}

nlohmann::json comparison_json(const ModelComparison& comparison) {
  nlohmann::json records = nlohmann::json::array();
  for (const RecordError& record : comparison.records)
    records.push_back(
        {{"record", record.path},
         {"error", to_json(record.error)},
         {"channels", channels_json(record.error)},
         {"combined", record.error.combined},
         {"relative_error", number_or_null(record.relative_error)},
         {"free_run", {{"given_samples", kGivenSamples}, {"position_rms", number_or_null(record.free_run)}}}});
  nlohmann::json document = {
      {"format", "axis-comparison/1"},
      {"relative_error", number_or_null(comparison.relative_error)},
      {"window_s", comparison.error.window_s},
      {"error", to_json(comparison.error)},
      {"channels", channels_json(comparison.error)},
      {"combined", comparison.error.combined},
      {"without_effects", {{"kinds", comparison.effects}, {"times", comparison.without_effects}}},
      {"where", error_regions_json(comparison.where)},
      {"where_in_words", where_it_fails(comparison.where)},
      {"log", log_faults_json(comparison.log_faults)},
      {"log_faults", log_faults_json(comparison.log_faults)},
      {"records", std::move(records)}};
  if (!comparison.table.empty()) document["table"] = table_json(comparison.table);
  return document;
}

}  // namespace host
