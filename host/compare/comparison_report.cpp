#include "host/compare/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>

#include "host/compare/effort_residual.hpp"
#include "host/report/binned_curve.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

constexpr double kAtFloor = 1.2;  ///< combined error up to which nothing is left to explain
constexpr double kNear = 2.0;

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

Table error_table(const ModelComparison& comparison) {
  Table table;
  table.title = "Prediction error";
  table.caption = fmt::format(
      "Predicted from the recorded command over {:g} s, restarted from the smoothed measurement.", comparison.window_s);
  table.headings = {"record", "channel", "unit", "RMS error", "floor", "fit", "error/floor", "inverse model"};
  const auto append = [&](const std::string& name, const std::vector<ChannelComparison>& channels, double combined,
                          const std::optional<double>& relative_error) {
    bool first = true;
    for (const ChannelComparison& channel : channels) {
      table.rows.push_back({first ? name : "", channel.name, channel.unit, format_value(channel.rms),
                            format_value(channel.floor), fmt::format("{:.2f} %", channel.fit_percent),
                            first ? format_value(combined) : "",
                            first && relative_error ? percent(*relative_error) : ""});
      first = false;
    }
  };
  for (const RecordError& record : comparison.records)
    append(file_name(record.path), record.channels, record.combined, record.relative_error);
  if (comparison.records.size() > 1) append("all", comparison.channels, comparison.combined, comparison.relative_error);
  return table;
}

/// The regions that hold most of the error beyond their part of the samples.
std::vector<ErrorRegion> outstanding(const std::vector<ErrorRegion>& where, std::size_t most) {
  std::vector<ErrorRegion> regions;
  for (const ErrorRegion& region : where)
    if (region.partition != "event" && region.partition != "place" && region.partition != "frequency" &&
        region.portion > 0.0 && region.share > region.portion && region.share > 0.05)
      regions.push_back(region);
  std::ranges::sort(regions, std::greater(),
                    [](const ErrorRegion& region) { return region.share * std::log(region.share / region.portion); });
  regions.resize(std::min(most, regions.size()));
  return regions;
}

BarChart bars_of(const std::vector<ErrorRegion>& where, const std::string& partition, const std::string& title) {
  BarChart chart;
  chart.title = title;
  chart.unit = "%";
  chart.series = {{"squared error", SeriesRole::residual}, {"samples", SeriesRole::floor}};
  if (partition == "order") chart.series.pop_back();
  for (const ErrorRegion& region : where) {
    if (region.partition != partition) continue;
    std::string label = region.region;
    std::ranges::replace(label, '_', ' ');
    BarRow row{label, {rounded_to_digits(100.0 * region.share, 3)}, {}};
    if (partition != "order") {
      row.values.push_back(rounded_to_digits(100.0 * region.portion, 3));
      row.note = format_value(region.rms) + " × floor";
    }
    chart.rows.push_back(std::move(row));
  }
  return chart;
}

TimePlot traces_of(const PreparedRecord& prepared, const Prediction& prediction) {
  const Record& record = *prepared.record;
  const bool rotary = record.kind == sim::DriveKind::rotary;
  TimePlot plot;
  plot.title = "Measured and predicted: " + file_name(record.path);
  plot.caption = "Predictions restart at every window: what grows from there to the next one is what the model lacks.";
  plot.t_s = record.t_s;
  const auto add = [&](const char* quantity, const char* unit, const std::vector<double>& measured,
                       const std::vector<double>& predicted) {
    std::vector<double> error(measured.size());
    std::ranges::transform(predicted, measured, error.begin(), std::minus<>());
    plot.panels.push_back(
        {quantity,
         unit,
         {{"measured", SeriesRole::measured, measured}, {"predicted", SeriesRole::predicted, predicted}}});
    plot.panels.push_back(
        {std::string(quantity) + " error", unit, {{"error", SeriesRole::residual, std::move(error)}}});
  };
  if (record.has_speed()) add("speed", rotary ? "rad/s" : "m/s", record.w, prediction.w);
  if (record.has_position()) add("position", rotary ? "mm" : "m", record.x, prediction.x);
  plot.panels.push_back({"command", "V", {{"command", SeriesRole::other, prepared.u_V}}});
  return plot;
}

ScatterPlot missing_against(const std::string& title, Axis coordinate, Axis value, const std::vector<double>& along,
                            const std::vector<double>& missing, const std::vector<double>& direction) {
  constexpr std::size_t kBins = 60;
  ScatterPlot plot;
  plot.title = title;
  plot.x = std::move(coordinate);
  plot.y = std::move(value);
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> x, y;
    for (std::size_t k = 0; k < along.size(); ++k) {
      if (direction[k] * sign <= 0.0) continue;
      x.push_back(along[k]);
      y.push_back(missing[k]);
    }
    const BinnedCurve curve = binned_curve(x, y, kBins);
    if (curve.x.empty()) continue;
    plot.series.push_back({sign > 0.0 ? "forward" : "backward", sign > 0.0 ? SeriesRole::residual : SeriesRole::other,
                           SeriesStyle::line_and_points, curve.x, curve.mean, curve.lower, curve.upper});
  }
  return plot;
}

/// Samples of all records behind one another.
ResidualSamples pooled_samples(const sim::DriveDescription& model, const RecordSet& set) {
  constexpr std::size_t kStride = 2;
  ResidualSamples pool;
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const ComparedRecord& compared : set.records) {
    const ResidualSamples samples = residual_samples(model, compared.prepared, kStride);
    append(pool.t_s, samples.t_s);
    append(pool.x, samples.x);
    append(pool.w, samples.w);
    append(pool.acceleration, samples.acceleration);
    append(pool.missing, samples.missing);
    append(pool.tach_error, samples.tach_error);
  }
  return pool;
}

void add_missing_effort(const sim::DriveDescription& model, const RecordSet& set, Report& report) {
  const ResidualSamples samples = pooled_samples(model, set);
  if (samples.w.empty()) return;
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  const Axis missing{rotary ? "missing torque" : "missing force", rotary ? "Nm" : "N"};
  const std::string effort = rotary ? "torque" : "force";
  report.section("What is missing, as " + effort,
                 "The " + effort +
                     " that the motion needed beyond what the model explains: mean in bins with the 10–90 % band, by "
                     "direction. A missing effect shows as a curve against the coordinate that it depends on.");
  const auto against = [&](const char* name, Axis axis, const std::vector<double>& along) {
    report.add(
        missing_against(fmt::format("Against {}", name), std::move(axis), missing, along, samples.missing, samples.w));
  };
  against("speed", {"speed", rotary ? "rad/s" : "m/s"}, samples.w);
  if (set.records.front().prepared.record->has_position())
    against("position", {"position", rotary ? "mm" : "m"}, samples.x);
  against("acceleration", {"acceleration", rotary ? "rad/s²" : "m/s²"}, samples.acceleration);
  against("time", {"time", "s"}, samples.t_s);
  if (samples.tach_error.size() != samples.w.size() || !set.records.front().prepared.record->has_position()) return;
  report.section("What the tachometer adds",
                 "Tachometer less what the model's tachometer reads at the encoder's speed.");
  const Axis error{"tachometer error", rotary ? "rad/s" : "m/s"};
  report.add(missing_against("Against speed", {"speed", rotary ? "rad/s" : "m/s"}, error, samples.w, samples.tach_error,
                             samples.w));
  report.add(missing_against("Against acceleration", {"acceleration", rotary ? "rad/s²" : "m/s²"}, error,
                             samples.acceleration, samples.tach_error, samples.w));
}

}  // namespace

Verdict comparison_verdict(const ModelComparison& comparison) {
  Verdict verdict;
  const std::string times = format_value(comparison.combined);
  if (!comparison.log_faults.empty()) {
    verdict.tone = Tone::bad;
    verdict.label = "check the log";
    verdict.headline = comparison.log_faults.size() == 1
                           ? "The record has a fault that no model can explain; mend it first."
                           : fmt::format("The records have {} faults that no model can explain; mend them first.",
                                         comparison.log_faults.size());
    for (const LogFault& fault : comparison.log_faults) verdict.sentences.push_back(fault.message + ".");
  } else if (comparison.combined <= kAtFloor) {
    verdict.tone = Tone::good;
    verdict.label = "fits";
    verdict.headline = fmt::format("The model predicts these records as well as any could (error {} × floor).", times);
    return verdict;
  } else {
    verdict.tone = comparison.combined <= kNear ? Tone::attention : Tone::bad;
    verdict.label = comparison.combined <= kNear ? "nearly fits" : "does not fit";
    verdict.headline = fmt::format("The prediction error is {} times what the best possible model would leave.", times);
  }
  std::string where = where_it_fails(comparison.where);
  where.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(where.front())));
  verdict.sentences.push_back(where + ".");
  if (comparison.log_faults.empty()) {
    verdict.sentences.push_back("Next: find out which effect is missing.");
    verdict.command = "axistool diagnose MODEL --train RECORD";
  }
  return verdict;
}

std::string comparison_text(const sim::DriveDescription& model, const ModelComparison& comparison,
                            const Terminal& terminal) {
  std::string text = terminal_verdict(comparison_verdict(comparison), terminal) + "\n";
  text += terminal_table(error_table(comparison), terminal);
  if (comparison.relative_error)
    text +=
        wrapped(fmt::format("\nThe inverse model leaves {} of the {} unexplained.", percent(*comparison.relative_error),
                            model.data.kind == sim::DriveKind::rotary ? "torque" : "force"),
                terminal.columns) +
        "\n";
  text += "\n" + terminal_bars(bars_of(comparison.where, "regime", "Share of the squared error by regime"), terminal);
  Table regions;
  regions.title = "Where the error stands out";
  regions.headings = {"by", "region", "of the squared error", "of the samples", "error/floor"};
  constexpr std::size_t kMostRegions = 8;
  for (const ErrorRegion& region : outstanding(comparison.where, kMostRegions))
    regions.rows.push_back(
        {region.partition, region.region, percent(region.share), percent(region.portion), format_value(region.rms)});
  if (!regions.rows.empty()) text += "\n" + terminal_table(regions, terminal);
  return text;
}

Report comparison_report(const sim::DriveDescription& model, const RecordSet& set, const ModelComparison& comparison) {
  std::string names;
  for (const RecordError& record : comparison.records) names += (names.empty() ? "" : ", ") + file_name(record.path);
  Report report("Model and measurement", fmt::format("model {} · {}", model.name, names));
  report.verdict(comparison_verdict(comparison));

  report.section("How far off");
  Facts facts;
  facts.items = {{"error over floor", format_value(comparison.combined)},
                 {"prediction window", fmt::format("{:g} s", comparison.window_s)}};
  if (comparison.relative_error) facts.items.emplace_back("inverse model's error", percent(*comparison.relative_error));
  std::string effects;
  for (const sim::EffectEntry& effect : model.effects) effects += (effects.empty() ? "" : ", ") + effect.kind;
  facts.items.emplace_back("effects in the model", effects);
  report.add(std::move(facts));
  report.add(error_table(comparison));

  const auto worst = std::ranges::max_element(comparison.records, {}, &RecordError::combined);
  const PreparedRecord& shown = set.records[static_cast<std::size_t>(worst - comparison.records.begin())].prepared;
  report.add(traces_of(shown, predict_all_rows(model, shown)));

  report.section("Where it fails",
                 "Each chart shares out the same squared error, in units of the floor. Where a region's part of the "
                 "error exceeds its part of the samples, something is missing there.");
  report.add(bars_of(comparison.where, "regime", "By what the axis does"));
  for (const auto& [partition, title] : {std::pair("direction", "By direction"), std::pair("speed", "By speed"),
                                         std::pair("position", "By position along the travel"),
                                         std::pair("order", "What repeats along the travel (of the missing effort)"),
                                         std::pair("rest", "By time at rest before moving"),
                                         std::pair("frequency", "By frequency"), std::pair("time", "By time")}) {
    BarChart chart = bars_of(comparison.where, partition, title);
    if (!chart.rows.empty()) report.add(std::move(chart));
  }
  add_missing_effort(model, set, report);
  return report;
}

}  // namespace host
