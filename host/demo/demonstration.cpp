#include "host/demo/demonstration.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/demo/emps_benchmark.hpp"
#include "host/demo/paper_axis.hpp"
#include "host/demo/shipped_drive.hpp"
#include "host/demo/tracking.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/report/progress.hpp"
#include "host/report/text_format.hpp"

namespace host {

bool Demonstration::agrees() const { return std::ranges::all_of(figures, &DemoFigure::agrees); }

Table figures_table(const std::vector<DemoFigure>& figures) {
  Table table;
  table.headings = {"what", "found", "should be", ""};
  for (const DemoFigure& figure : figures) {
    table.rows.push_back(
        {figure.what, format_value(figure.found, 4), figure.reference, figure.agrees() ? "agrees" : "DIFFERS"});
  }
  return table;
}

Demonstration demonstrate(const DemonstrationInput& input) {
  constexpr std::string_view kAxes[] = {"x", "y"};
  Report details("axistool: the demonstration", "Feed drives identified, controlled and checked");
  std::vector<DemoFigure> figures;
  std::vector<std::string> sentences;
  const auto keep = [&](DemoPart part) {
    sentences.push_back(std::move(part.sentence));
    figures.insert(figures.end(), std::make_move_iterator(part.figures.begin()),
                   std::make_move_iterator(part.figures.end()));
  };

  Progress progress("demonstration", 1 + (input.emps_folder ? 1 : 0) + 2 * std::size(kAxes));
  keep(show_shipped_drive(input.drive_case, details));
  progress.advance(1, "drive identified from its record");
  if (input.emps_folder) {
    keep(show_emps(*input.emps_folder, details));
    progress.advance(1, "EMPS identified");
  }
  for (const std::string_view axis : kAxes) {
    PaperAxisOutcome outcome = show_paper_axis(axis, details);
    keep(std::move(outcome.part));
    progress.advance(1, fmt::format("axis {} identified", axis));
    keep(show_tracking(*paper_drive(axis), outcome.identified, details));
    progress.advance(1, fmt::format("axis {} controlled", axis));
  }

  Demonstration shown{std::move(details), std::move(figures)};
  shown.report.section("All figures", "Results and their reference values.");
  shown.report.add(figures_table(shown.figures));
  const auto agreeing = std::ranges::count_if(shown.figures, &DemoFigure::agrees);
  Verdict verdict;
  verdict.tone = shown.agrees() ? Tone::good : Tone::bad;
  verdict.label = shown.agrees() ? "all agree" : "differs";
  verdict.headline = fmt::format("{} of {} figures agree with their reference.", agreeing, shown.figures.size());
  verdict.sentences = std::move(sentences);
  shown.report.verdict(std::move(verdict));
  return shown;
}

}  // namespace host
