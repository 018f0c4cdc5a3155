#include "host/diagnose/figure_rows.hpp"

#include <algorithm>

#include "host/evidence/measured_sensors.hpp"
#include "host/identify/effort_timing.hpp"

namespace host {

namespace {

std::vector<FigureRecord> windows_of(const RecordSet& set) {
  std::vector<FigureRecord> rows;
  for (const ComparedRecord& compared : set.records)
    rows.push_back({compared.prepared.record, compared.prepared.windows});
  return rows;
}

std::vector<FigureRecord> all_of(const std::vector<const Record*>& records) {
  std::vector<FigureRecord> rows;
  for (const Record* record : records) rows.push_back({record});
  return rows;
}

}  // namespace

nlohmann::json to_json(const ErrorOnSets& error) {
  return {{"train", to_json(error.train)}, {"validate", to_json(error.validate)}};
}

ErrorOnSets FigureRows::error_of(sim::DriveDescription model) const {
  model.data = data;
  const auto error_on = [&](std::vector<FigureRecord> rows) {
    std::vector<const Record*> records;
    for (const FigureRecord& one : rows) records.push_back(one.record);
    const std::vector<Record> timed = timed_beside(model, records);
    for (std::size_t k = 0; k < timed.size(); ++k) rows[k].record = &timed[k];
    return error_figures(model, rows);
  };
  return {error_on(train), error_on(validate)};
}

FigureRows figure_rows(const sim::DriveDescription& given, const Measurements& measured, const PreparedSets* split) {
  const std::vector<const Record*> training = measured.training_records(), validation = measured.validation_records();
  if (!validation.empty()) return {all_of(training), all_of(validation), given.data};
  if (split != nullptr && split->measure == Measure::motion && split->window_s == kWindow_s)
    return {windows_of(split->training), windows_of(split->validation), given.data};
  const PreparedSets usual = split_sets(with_measured_sensors(given, measured), training, {});
  return {windows_of(usual.training), windows_of(usual.validation), given.data};
}

bool is_worse(const ErrorFigures& error, const ErrorFigures& given) {
  constexpr double kRounding = 1e-9;
  std::size_t farther = 0;
  for (const ChannelFigures& channel : error.channels) {
    const auto before = std::ranges::find(given.channels, channel.name, &ChannelFigures::name);
    if (before != given.channels.end() && !(channel.rms <= (1.0 + kRounding) * before->rms)) ++farther;
  }
  if (farther == 0) return false;
  return farther == error.channels.size() || !(error.combined <= (1.0 + kRounding) * given.combined);
}

}  // namespace host
