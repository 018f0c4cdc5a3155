#include "host/hil/before_after_report.hpp"

#include <fmt/format.h>

#include "host/hil/circle_plot.hpp"
#include "host/report/text_format.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

struct Measured {
  std::string what;
  double before = 0.0, after = 0.0;
};

/// The largest errors; the first one is in the headline of the page.
std::vector<Measured> largest_errors(const ScenarioRun& before, const ScenarioRun& after) {
  std::vector<Measured> all;
  if (!before.contour_um.empty() && !after.contour_um.empty())
    all.push_back({"contour error", largest_magnitude(before.contour_um), largest_magnitude(after.contour_um)});
  for (std::size_t i = 0; i < hal::kAxisCount; ++i)
    all.push_back({fmt::format("tracking error of {}", kAxisNames[i]), largest_magnitude(before.tracking_um[i]),
                   largest_magnitude(after.tracking_um[i])});
  return all;
}

std::string change(const Measured& one) {
  return fmt::format("{} {} → {} µm", one.what, format_value(one.before), format_value(one.after));
}

/// Effects in the new model of an axis that the old one lacked.
std::string what_is_new(const ScenarioRun& before, const ScenarioRun& after, const ReplacedModel& model) {
  std::string kinds;
  for (const sim::EffectEntry& effect : after.believed[model.axis].effects)
    if (before.believed[model.axis].find(effect.kind) == nullptr) kinds += (kinds.empty() ? "" : ", ") + effect.kind;
  return fmt::format("Axis {}: {}, which {}.", kAxisNames[model.axis], model.path,
                     kinds.empty() ? "has the same effects as before" : "knows of " + kinds + " too");
}

Table table_of(const ScenarioRun& before, const ScenarioRun& after) {
  Table table;
  table.title = "Errors, µm";
  table.headings = {"", "before", "after", "of it remains"};
  const auto add = [&table](const Measured& one) {
    table.rows.push_back({one.what, format_value(one.before), format_value(one.after),
                          one.before > 0.0 ? fmt::format("{:.0f} %", 100.0 * one.after / one.before) : "–"});
  };
  for (Measured one : largest_errors(before, after)) {
    one.what = "largest " + one.what;
    add(one);
  }
  for (std::size_t i = 0; i < hal::kAxisCount; ++i)
    add({fmt::format("RMS tracking error of {}", kAxisNames[i]), root_mean_square(before.tracking_um[i]),
         root_mean_square(after.tracking_um[i])});
  return table;
}

TimePlot errors_over_time(const ScenarioRun& before, const ScenarioRun& after) {
  TimePlot plot;
  plot.title = "Errors over time";
  plot.caption = "Reference minus encoder; distance from the path.";
  plot.t_s = before.records[0].t_s;
  const auto add = [&](const std::string& what, const std::vector<double>& one, const std::vector<double>& other) {
    if (one.size() == plot.t_s.size() && other.size() == plot.t_s.size())
      plot.panels.push_back({what, "µm", {{"before", SeriesRole::before, one}, {"after", SeriesRole::after, other}}});
  };
  add("contour error", before.contour_um, after.contour_um);
  for (std::size_t i = 0; i < hal::kAxisCount; ++i)
    add(fmt::format("tracking error of {}", kAxisNames[i]), before.tracking_um[i], after.tracking_um[i]);
  return plot;
}

}  // namespace

std::string before_and_after(const ScenarioRun& before, const ScenarioRun& after) {
  return change(largest_errors(before, after).front());
}

Report before_after_report(const Scenario& scenario, const ScenarioRun& before, const ScenarioRun& after,
                           const std::vector<ReplacedModel>& models) {
  Report report(scenario.name, scenario.path + ", before and after");
  const Measured first = largest_errors(before, after).front();
  Verdict verdict;
  verdict.label = first.after < first.before ? "better" : "no better";
  verdict.tone = !after.holds() ? Tone::bad : first.after < first.before ? Tone::good : Tone::attention;
  verdict.headline = capitalised(change(first));
  if (!after.holds()) verdict.sentences.push_back("Afterwards a required condition fails.");
  if (after.misses_aim()) verdict.sentences.push_back("Afterwards a target of the scenario is still missed.");
  if (!scenario.about.empty()) verdict.sentences.push_back(scenario.about);
  for (const ReplacedModel& model : models) verdict.sentences.push_back(what_is_new(before, after, model));
  report.verdict(verdict);
  report.section("Before and after");
  if (auto circle =
          circle_plot(scenario, {{"before", SeriesRole::before, &before}, {"after", SeriesRole::after, &after}}))
    report.add(std::move(*circle));
  report.add(table_of(before, after));
  report.add(errors_over_time(before, after));
  return report;
}

}  // namespace host
