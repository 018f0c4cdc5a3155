#include "host/workbench/story.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/compare/comparison_report.hpp"
#include "host/exit_codes.hpp"
#include "host/report/text_format.hpp"
#include "host/statistics.hpp"
#include "host/workbench/actions.hpp"

namespace host::workbench {

namespace {

using nlohmann::json;

BarRow row_of(const std::string& label, const json& error) {
  return {
      label, {error.at("train").at("combined").get<double>(), error.at("validate").at("combined").get<double>()}, ""};
}

/// Bars of the error from the given model on; each step of an improvement has its own bar.
BarChart ladder_of(const std::vector<json>& steps) {
  BarChart chart;
  chart.title = "Error in multiples of the noise floor";
  chart.series = {{"train", SeriesRole::train}, {"validation", SeriesRole::validate}};
  chart.reference = {"noise floor", 1.0};
  for (const json& step : steps) {
    const json &request = step.at("request"), &document = step.at("document");
    if (chart.rows.empty())
      chart.rows.push_back(row_of(request.at("model").get<std::string>(), document.at("error").at("given")));
    if (!document.contains("ladder")) {
      const std::string kind = request.value("kind", "");
      chart.rows.push_back(row_of(kind.empty() ? "adjusted" : "+ " + spaced(kind), document.at("error").at("after")));
      continue;
    }
    for (const json& rung : document.at("ladder"))
      if (const auto added = rung.at("added").get<std::vector<std::string>>(); !added.empty())
        chart.rows.push_back(row_of(spaced(fmt::format("+ {}", fmt::join(added, ", "))), rung.at("error")));
  }
  return chart;
}

Table parameters_of(const json& parameters) {
  Table table;
  table.title = "Parameters of the last fit";
  table.headings = {"parameter", "value", "+- (95 %)"};
  for (const json& one : parameters)
    table.rows.push_back({one.at("name").get<std::string>(), format_value(one.at("value").get<double>(), 5),
                          one.at("determined").get<bool>() ? format_value(kNormal95 * one.at("deviation").get<double>())
                                                           : "not determined"});
  return table;
}

}  // namespace

std::string story_page(const Folder& folder, const Request& request, const std::vector<json>& steps) {
  const std::vector<ComparedModel> models = compared_models(folder, request);
  Report report = comparison_report(models, request.focus);
  try {
    report.section("Steps");
    if (!steps.empty()) report.add(ladder_of(steps));
    if (!steps.empty() && steps.back().at("document").contains("parameters"))
      report.add(parameters_of(steps.back().at("document").at("parameters")));
    Table commands;
    commands.title = "Commands to repeat it, in the folder";
    commands.headings = {"command"};
    for (const json& step : steps) commands.rows.push_back({step.at("command").get<std::string>()});
    commands.rows.push_back({command_line(request, {})});
    report.add(std::move(commands));
  } catch (const json::exception& damaged) {
    throw Failure(ExitCode::bad_input, fmt::format("a job in {} is damaged: {}", kOwnFolder, damaged.what()));
  }
  return report.html();
}

}  // namespace host::workbench
