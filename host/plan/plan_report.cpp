#include "host/plan/plan_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/record/drive_units.hpp"
#include "host/report/report.hpp"

namespace host {

namespace {

std::vector<std::string> names_of(const std::vector<Rival>& rivals) {
  std::vector<std::string> names;
  for (const Rival& rival : rivals) names.push_back(rival_name(rival.kinds));
  return names;
}

Verdict verdict_block(const Plan& plan, const std::string& run_file) {
  Verdict block;
  block.tone = plan.separable ? Tone::attention : Tone::neutral;
  block.label = plan.separable ? "a run decides" : "by hand";
  const std::string group = fmt::format("{}", fmt::join(names_of(plan.rivals), " or "));
  if (plan.separable) {
    block.headline = fmt::format("A run of {:.3g} s separates {}: {}", plan.run.duration_s(),
                                 plan.by_hand.empty() ? "the explanations" : "some of the explanations", group);
    block.sentences.push_back(fmt::format("Expected odds of the true one: {}.", odds_text(plan.expected_odds)));
    block.command = fmt::format("axistool excite AXIS {} -o run.csv", run_file);
  } else {
    block.headline = fmt::format("No motion in this box separates {}", group);
  }
  if (!plan.by_hand.empty()) block.sentences.push_back(plan.by_hand);
  return block;
}

void add_pairs(Report& report, const Plan& plan) {
  Table table;
  table.title = "Pair by pair";
  table.headings = {"pair", "expected odds if it is the first", "if it is the second", "by hand"};
  for (const PairOutlook& pair : plan.pairs)
    table.rows.push_back(
        {fmt::format("{} or {}", rival_name(plan.rivals[pair.a].kinds), rival_name(plan.rivals[pair.b].kinds)),
         pair.separable ? odds_text(pair.odds_if_a) : "none", pair.separable ? odds_text(pair.odds_if_b) : "none",
         pair.by_hand});
  report.add(table);
}

/// Predictions of both rivals of a pair for the run in which the first one is true.
void add_parting(Report& report, const Plan& plan, const PairOutlook& pair) {
  const PredictedRun& run = plan.predicted[pair.a];
  const RecordSet set = common_ground({&run.record}, plan.rivals);
  const PreparedRecord& prepared = set.records.front().prepared;
  const bool by_speed = run.record.has_speed();
  const std::vector<double>& measured = by_speed ? run.record.w : run.record.x;
  TimePlot plot;
  const std::string truth = rival_name(plan.rivals[pair.a].kinds), other = rival_name(plan.rivals[pair.b].kinds);
  plot.title = fmt::format("If it is {}", truth);
  plot.caption = fmt::format(
      "Residual of the run, window by window, when {} predicts it, and when {} does after refitting its parameters "
      "within the limits of the earlier records.",
      truth, other);
  plot.t_s = run.record.t_s;
  const DriveUnits units = units_of(run.record.kind);
  const std::string unit = by_speed ? units.speed : units.travel;
  plot.panels.push_back({"command", "V", {{"command", SeriesRole::other, run.record.u_V}}});
  plot.panels.push_back({by_speed ? "speed" : "position", unit, {{"run", SeriesRole::measured, measured}}});
  TracePanel left{by_speed ? "speed left" : "position left", unit, {}};
  for (const auto& [rival, role] : {std::pair{pair.b, SeriesRole::before}, std::pair{pair.a, SeriesRole::after}}) {
    Prediction prediction;
    prediction.x.assign(measured.size(), std::nan(""));
    prediction.w = prediction.x;
    predict(sim::Drive(run.bent[rival]), prepared, prediction);
    std::vector<double> values = by_speed ? prediction.w : prediction.x;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = measured[k] - values[k];
    left.traces.push_back({rival_name(plan.rivals[rival].kinds), role, std::move(values)});
  }
  plot.panels.push_back(std::move(left));
  report.add(std::move(plot));
}

void add_considered(Report& report, const Plan& plan) {
  constexpr std::size_t kShown = 12;
  BarChart chart;
  chart.title = "Pieces tried";
  chart.caption =
      "Natural logarithm of the expected odds from one piece alone, for the pair of rivals that it separates worst, "
      "with the rivals refitted by linearisation. The odds above are for all chosen pieces together, after a full "
      "refit.";
  chart.series = {{"log odds", SeriesRole::model}};
  chart.reference = {"19 to 1", std::log(kDecided / (1.0 - kDecided))};
  for (std::size_t k = 0; k < std::min(kShown, plan.considered.size()); ++k)
    chart.rows.push_back(
        {piece_text(plan.considered[k].piece), {std::max(0.0, plan.considered[k].expected_log_odds)}, ""});
  report.add(chart);
}

}  // namespace

void write_plan_report(const Plan& plan, const std::string& model_name, const std::string& run_file,
                       const std::string& path) {
  Report report("Plan for " + model_name, "The run that tells the remaining explanations apart");
  report.verdict(verdict_block(plan, run_file));
  report.section("What to expect", "");
  add_pairs(report, plan);
  if (plan.separable) {
    report.section("The run", "Pieces of excitation, one after the other in one record, within the box.");
    Table table;
    table.headings = {"piece"};
    for (const RunPiece& piece : plan.run.pieces) table.rows.push_back({piece_text(piece)});
    report.add(table);
    for (const PairOutlook& pair : plan.pairs)
      if (pair.separable) add_parting(report, plan, pair);
    report.section("Other pieces tried", "");
    add_considered(report, plan);
  }
  report.write(path);
}

}  // namespace host
