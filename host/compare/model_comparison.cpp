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

/// Sums of one channel over used windows of one or all records.
struct ChannelSums {
  double error = 0.0, floor = 0.0, values = 0.0, squares = 0.0;
  std::size_t rows = 0, windows = 0;

  void add_window(const std::vector<double>& predicted, const std::vector<double>& measured, const Window& window,
                  double window_floor) {
    for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k) {
      error += (predicted[k] - measured[k]) * (predicted[k] - measured[k]);
      values += measured[k];
      squares += measured[k] * measured[k];
    }
    rows += window.length;
    floor += window_floor * window_floor;
    ++windows;
  }
  void append_to(std::vector<ChannelComparison>& channels, std::string_view name, const char* unit) const {
    if (rows == 0) return;
    const auto n = static_cast<double>(rows);
    const double spread = std::max(0.0, squares - values * values / n);
    channels.push_back({std::string(name), unit, std::sqrt(error / n),
                        spread > 0.0 ? 100.0 * (1.0 - std::sqrt(error / spread)) : 0.0,
                        std::sqrt(floor / static_cast<double>(windows))});
  }
};

struct Sums {
  ChannelSums x, w;
  double squares = 0.0;  ///< of error over floor, window by window
  std::size_t scores = 0;

  double combined() const { return scores == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(scores)); }
  std::vector<ChannelComparison> channels(sim::DriveKind kind) const {
    std::vector<ChannelComparison> list;
    const bool rotary = kind == sim::DriveKind::rotary;
    w.append_to(list, column_name(&Record::w, kind), rotary ? "rad/s" : "m/s");
    x.append_to(list, column_name(&Record::x, kind), rotary ? "mm" : "m");
    return list;
  }
};

void add_record(const ComparedRecord& compared, const Prediction& prediction, std::size_t stride, Sums& sums) {
  const PreparedRecord& prepared = compared.prepared;
  const ErrorFloor& floor = compared.floor;
  for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
    const Window& window = prepared.windows[index];
    const auto add = [&](ChannelSums& channel, const std::vector<double>& predicted,
                         const std::vector<double>& measured, double window_floor) {
      const double before = channel.error;
      channel.add_window(predicted, measured, window, window_floor);
      sums.squares += (channel.error - before) / static_cast<double>(window.length) / (window_floor * window_floor);
      ++sums.scores;
    };
    if (!floor.x.empty()) add(sums.x, prediction.x, prepared.record->x, floor.x[index]);
    if (!floor.w.empty()) add(sums.w, prediction.w, prepared.record->w, floor.w[index]);
  }
}

/// Empty where the records cannot say: the axis never slides, or a record is too short for the filter.
std::optional<double> inverse_error(const sim::DriveDescription& model, const std::vector<Record>& records) {
  try {
    return relative_error(model, records);
  } catch (const Failure&) {
    return {};
  }
}

nlohmann::json channels_json(const std::vector<ChannelComparison>& channels) {
  nlohmann::json object = nlohmann::json::object();
  for (const ChannelComparison& channel : channels)
    object[channel.name] = {{"rms", channel.rms}, {"fit", channel.fit_percent}, {"floor", channel.floor}};
  return object;
}

nlohmann::json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

/// What the file multiplies a channel's own unit by: 1000 where it gives mm and the drive counts in m.
double factor_in_file(const Record& record, std::vector<double> Record::*channel) {
  const KnownColumn* column = find_known_column(name_in_file(record, channel));
  const bool rotary = record.kind == sim::DriveKind::rotary;
  if (column == nullptr || column->unit == ColumnUnit::as_is) return 1.0;
  if (column->unit == ColumnUnit::m) return rotary ? 1e-3 : 1.0;
  return rotary ? 1.0 : 1e3;
}

}  // namespace

ModelComparison compare_model(const sim::DriveDescription& model, const Measurements& measured, const RecordSet& set,
                              double window_s) {
  const std::vector<Record>& records = measured.training();
  ModelComparison comparison;
  comparison.window_s = window_s;
  const sim::Drive drive(model);
  Sums all;
  Prediction prediction;
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    predict(drive, set.records[r].prepared, prediction, set.stride);
    Sums own;
    add_record(set.records[r], prediction, set.stride, own);
    add_record(set.records[r], prediction, set.stride, all);
    comparison.records.push_back({records[r].path, own.channels(model.data.kind), own.combined(),
                                  inverse_error(model, {records[r]}), free_run_rms(model, set.records[r].prepared)});
  }
  comparison.log_faults = measured.log();
  comparison.channels = all.channels(model.data.kind);
  comparison.combined = all.combined();
  comparison.relative_error = inverse_error(model, records);
  comparison.where = error_regions(model, set);
  return comparison;
}

Prediction predict_all_rows(const sim::DriveDescription& model, PreparedRecord prepared) {
  const sim::Drive drive(model);
  const std::size_t end = prepared.windows.back().begin + prepared.windows.back().length;
  if (end + 1 < prepared.record->size()) {
    prepared.windows.push_back({end, prepared.record->size() - 1 - end});
    auto weights = *prepared.shift_weights;
    if (end / prepared.windows.front().length == weights.size())
      weights.push_back(prepared.smoother.shift_weights(end));
    prepared.shift_weights = std::make_shared<const std::vector<ShiftWeights>>(std::move(weights));
  }
  Prediction prediction;
  predict(drive, prepared, prediction);
  const sim::DriveState start = restart_states(drive, prepared).front();
  prediction.x.front() = drive.encoder(start);
  prediction.w.front() = drive.tachometer(start);
  return prediction;
}

std::vector<std::pair<std::string, std::vector<double>>> predicted_columns(const sim::DriveDescription& model,
                                                                           const PreparedRecord& prepared) {
  const Record& record = *prepared.record;
  Prediction prediction = predict_all_rows(model, prepared);
  std::vector<std::pair<std::string, std::vector<double>>> columns{{"t_s", record.t_s}};
  for (const auto channel : {&Record::w, &Record::x}) {
    if ((record.*channel).empty()) continue;
    columns.emplace_back(name_in_file(record, channel), record.*channel);
    for (double& value : columns.back().second) value *= factor_in_file(record, channel);
  }
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  columns.emplace_back(rotary ? "x_pred_mm" : "x_pred_m", std::move(prediction.x));
  columns.emplace_back(rotary ? "w_pred_rad_s" : "v_pred_m_s", std::move(prediction.w));
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
         {"channels", channels_json(record.channels)},
         {"combined", record.combined},
         {"relative_error", number_or_null(record.relative_error)},
         {"free_run", {{"given_samples", kGivenSamples}, {"position_rms", number_or_null(record.free_run)}}}});
  return {{"format", "axis-comparison/1"},
          {"relative_error", number_or_null(comparison.relative_error)},
          {"window_s", comparison.window_s},
          {"channels", channels_json(comparison.channels)},
          {"combined", comparison.combined},
          {"where", error_regions_json(comparison.where)},
          {"where_in_words", where_it_fails(comparison.where)},
          {"log", log_faults_json(comparison.log_faults)},
          {"log_faults", log_faults_json(comparison.log_faults)},
          {"records", std::move(records)}};
}

}  // namespace host
