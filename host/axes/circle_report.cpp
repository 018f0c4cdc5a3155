#include "host/axes/circle_report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace host {

namespace {

std::string name_of(const CirclePass& pass) {
  return fmt::format("{} at {:.3g} mm/s", pass.is_ccw ? "counter-clockwise" : "clockwise", pass.feed_mm_s);
}

std::string detail(const CircleFinding& found) {
  const CircleCause& cause = found.cause;
  if (cause.period_mm)
    return fmt::format("{:.2f} µm every {:.3g} mm{}", found.amount, *cause.period_mm,
                       found.period_turns ? fmt::format(" ({:.3g} turns)", *found.period_turns) : "");
  if (cause.frequency_Hz) return fmt::format("{:.2f} µm at {:.3g} Hz", found.amount, *cause.frequency_Hz);
  std::string unit = cause.amount_unit;
  if (unit.starts_with("um")) unit.replace(0, 1, "µ");
  return fmt::format("{:.3g} {}", found.amount, unit);
}

std::string instead_text(const CircleFinding& found) {
  std::string text;
  for (const auto& [name, probability] : found.instead)
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", name, 100.0 * probability);
  return text;
}

Table causes_table(const CircleDiagnosis& diagnosis) {
  Table table;
  table.title = "Causes";
  table.caption =
      "µm: contribution of each cause alone to the circular deviation of both directions (largest minus smallest "
      "radial deviation), with its 95 % interval. Causes below a twentieth of the total are last.";
  table.headings = {"cause", "axis", "µm", "95 %", "probability", "size", "or instead"};
  table.stacks = true;
  for (const auto* const list : {&diagnosis.causes, &diagnosis.minor})
    for (const CircleFinding& found : *list)
      table.rows.push_back({found.cause.kind, found.cause.axis, fmt::format("{:.2f}", found.um),
                            fmt::format("{:.2f} to {:.2f}", found.ci95[0], found.ci95[1]),
                            fmt::format("{:.3f}", found.probability), detail(found), instead_text(found)});
  return table;
}

Table figures_table(const CircleDiagnosis& diagnosis) {
  Table table;
  table.title = "Terms of ISO 230-4, µm";
  table.caption =
      "G: circular deviation, largest minus smallest radius about the best-fit centre. F: radial deviation from the "
      "nominal circle, largest and smallest. G(b): circular deviation of both directions together. H: hysteresis, "
      "largest difference of both directions at one angle. Means over one degree.";
  table.headings = {"", "G, G(b)", "F max", "F min", "H"};
  for (std::size_t i = 0; i < diagnosis.passes.size(); ++i) {
    const CircleFigures& one = diagnosis.figures[i];
    table.rows.push_back({name_of(diagnosis.passes[i]), fmt::format("{:.2f}", one.G_um),
                          fmt::format("{:.2f}", one.F_max_um), fmt::format("{:.2f}", one.F_min_um), ""});
  }
  if (diagnosis.both)
    table.rows.push_back({"both directions, at the worst feed", fmt::format("{:.2f}", diagnosis.both->Gb_um), "", "",
                          fmt::format("{:.2f}", diagnosis.both->H_um)});
  return table;
}

PolarTrace trace_of(const CirclePass& pass, const std::vector<double>& deviation_um) {
  return {name_of(pass), pass.is_ccw ? SeriesRole::measured : SeriesRole::predicted, pass.angle_rad, deviation_um};
}

PolarPlot as_seen(const CircleDiagnosis& diagnosis) {
  PolarPlot plot;
  plot.title = "The circle";
  plot.caption = diagnosis.passes.front().outer_um.empty() ? "From the motors' encoders." : "From the outer sensor.";
  plot.radius_mm = diagnosis.passes.front().radius_mm;
  for (const CirclePass& pass : diagnosis.passes)
    plot.traces.push_back(trace_of(pass, pass.outer_um.empty() ? pass.encoder_um : pass.outer_um));
  return plot;
}

PolarPlot share_of(const CircleDiagnosis& diagnosis, const CircleFinding& found) {
  PolarPlot plot;
  plot.title = fmt::format("{} {}: {:.2f} µm", found.cause.kind, found.cause.axis, found.um);
  plot.caption = fmt::format("{}. Next: {}.", cause_text(found.cause.kind).title, cause_text(found.cause.kind).next);
  plot.radius_mm = diagnosis.passes.front().radius_mm;
  for (const CirclePass& pass : diagnosis.passes) plot.traces.push_back(trace_of(pass, share_along(found, pass)));
  return plot;
}

Verdict verdict_of(const CircleDiagnosis& diagnosis) {
  Verdict verdict;
  if (diagnosis.causes.empty()) {
    verdict.tone = Tone::neutral;
    verdict.label = "no cause";
    verdict.headline = "These sensors show no cause above the noise.";
  } else {
    const CircleFinding& first = diagnosis.causes.front();
    verdict.tone = Tone::attention;
    verdict.label = "cause found";
    verdict.headline = fmt::format("{}{}: {:.2f} µm ({:.2f} to {:.2f}), probability {:.3f}.", first.cause.kind,
                                   first.cause.axis == "xy" ? "" : " of " + first.cause.axis, first.um, first.ci95[0],
                                   first.ci95[1], first.probability);
    verdict.sentences.push_back(
        fmt::format("{}. Next: {}.", cause_text(first.cause.kind).title, cause_text(first.cause.kind).next));
  }
  return verdict;
}

Table unseen_table(const CircleDiagnosis& diagnosis) {
  Table table;
  table.title = "What these records cannot show";
  table.headings = {"cause", "why"};
  for (const Unseen& one : diagnosis.unseen) table.rows.push_back({one.kind, one.why});
  return table;
}

}  // namespace

Report circle_report(const CircleDiagnosis& diagnosis, const std::string& subtitle) {
  Report report("Circle", subtitle);
  report.verdict(verdict_of(diagnosis));
  report.section("Measured circle");
  report.add(as_seen(diagnosis));
  report.add(figures_table(diagnosis));
  report.section("Causes", fmt::format("Unexplained: {:.2f} µm RMS beyond noise.", diagnosis.rest_um));
  report.add(causes_table(diagnosis));
  for (const CircleFinding& found : diagnosis.causes) report.add(share_of(diagnosis, found));
  report.section("Not observable");
  report.add(unseen_table(diagnosis));
  return report;
}

std::string circle_text(const CircleDiagnosis& diagnosis, const Terminal& terminal) {
  std::string text = terminal_verdict(verdict_of(diagnosis), terminal);
  if (!diagnosis.causes.empty()) text += terminal_table(causes_table(diagnosis), terminal);
  text += fmt::format(
      "Unexplained: {:.2f} µm RMS beyond noise.\n"
      "\n",
      diagnosis.rest_um);
  text += terminal_table(figures_table(diagnosis), terminal);
  return text + terminal_table(unseen_table(diagnosis), terminal);
}

}  // namespace host
