#include "host/hil/scenario_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "host/hil/scenario_report.hpp"

namespace host {

namespace {

std::string title_of(const IndexLine& line) { return std::filesystem::path(line.page).stem().string(); }

int rank(const IndexLine& line) { return !line.holds ? 0 : line.misses_aim ? 1 : 2; }

}  // namespace

IndexLine index_line(const Scenario& scenario, const ScenarioRun& run, const std::string& page) {
  return {page, scenario.name, summary_of(run), run.holds(), run.misses_aim()};
}

Verdict index_verdict(const std::vector<IndexLine>& lines) {
  const auto held = std::ranges::count_if(lines, &IndexLine::holds);
  const bool all = held == static_cast<std::ptrdiff_t>(lines.size());
  Verdict verdict;
  verdict.tone = all ? Tone::good : Tone::bad;
  verdict.label = all ? "all hold" : "not all hold";
  verdict.headline = fmt::format("{} of {} scenarios hold", held, lines.size());
  for (const IndexLine& line : lines) {
    if (!line.holds) verdict.sentences.push_back(fmt::format("{} FAILS: {}.", title_of(line), line.summary));
    if (line.holds && line.misses_aim)
      verdict.sentences.push_back(fmt::format("{} misses its target: {}.", title_of(line), line.summary));
  }
  return verdict;
}

Report scenario_index(const std::vector<IndexLine>& lines) {
  std::vector<IndexLine> sorted = lines;
  std::ranges::stable_sort(sorted, {}, rank);
  Report report("Scenarios", fmt::format("{} runs of the firmware around simulated drives", lines.size()));
  report.verdict(index_verdict(lines));
  Table table;
  table.headings = {"scenario", "", "result", "what it is"};
  for (const IndexLine& line : sorted) {
    const char* outcome = !line.holds ? "FAILS" : line.misses_aim ? "misses its target" : "holds";
    table.rows.push_back({title_of(line), outcome, line.summary, line.name});
    table.links.push_back(line.page);
  }
  report.add(std::move(table));
  return report;
}

}  // namespace host
