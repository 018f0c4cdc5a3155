#include "host/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "host/exit_codes.hpp"
#include "tests/host/report/sample_report.hpp"
#include "tests/host/temporary_folder.hpp"

namespace host {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The data between the markup and the sources of the scripts.
nlohmann::json plots_of(const std::string& html) {
  const std::string mark = "id=\"plots\">";
  const std::size_t begin = html.find(mark) + mark.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(Report, ShowsTheVerdictFirstAndTheBlocksInOrder) {
  const std::string html = sample::report().html();
  std::size_t last = 0;
  for (const char* text : {"<h1>", "Cogging is missing.", "It repeats every 10 mm.", "axistool add", "train.csv",
                           "Friction curve", "Order spectrum", "How much", "Ladder of errors", "Parameters"}) {
    const std::size_t at = html.find(text, last);
    ASSERT_NE(at, std::string::npos) << text;
    last = at;
  }
}

TEST(Report, NoTextOfTheUserBecomesMarkup) {
  const std::string html = sample::report().html();
  EXPECT_THAT(html, Not(HasSubstr("<script>document.title")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;document.title=&#39;taken over&#39;"));
}

TEST(Report, NeedsNothingFromOutside) {
  const std::string html = sample::report().html();
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr("sourceMappingURL=")));
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, HasSubstr("Dygraph.synchronize = synchronize"));
}

TEST(Report, PlotsCarryUnitsSamplesAndErrorBars) {
  const nlohmann::json plots = plots_of(sample::report(1000).html());
  ASSERT_EQ(plots.size(), 3U);
  EXPECT_EQ(plots[0]["panels"][0]["label"], "speed [rad/s]");
  EXPECT_EQ(plots[0]["panels"][0]["series"][1]["y"]["base64"].get<std::string>().size(), 4U * 1000U);
  EXPECT_EQ(plots[1]["xLabel"], "speed [rad/s]");
  EXPECT_EQ(plots[1]["series"][1]["lower"].size(), 10U);
  EXPECT_EQ(plots[1]["series"][0]["y"][20], nullptr) << "a NaN is a gap";
  EXPECT_EQ(plots[2]["logarithmic"], true);
}

TEST(Report, BarsAreScaledToTheLongestAndMissingOnesSaySo) {
  const std::string html = sample::report().html();
  EXPECT_THAT(html, HasSubstr("width:100.00%;background:var(--model)"));
  EXPECT_THAT(html, HasSubstr("width:80.00%;background:var(--train)"));
  EXPECT_THAT(html, HasSubstr("<i class=\"reference\" style=\"left:10.00%\">"));
  EXPECT_THAT(html, HasSubstr("title=\"validation\">–</span>"));
}

TEST(Report, NumbersInATableStandToTheRight) {
  EXPECT_THAT(sample::report().html(), HasSubstr("<td class=\"number\">-1.5</td>"));
}

TEST(Report, StaysLightHoweverLongTheRecordsAre) {
  Report report = sample::report(10);
  for (int record = 0; record < 4; ++record) report.add(sample::time_plot(300'000));
  const std::string html = report.html();
  EXPECT_LT(html.size(), 3'000'000U);
  const nlohmann::json panel = plots_of(html)[4]["panels"][0];
  EXPECT_GT(panel["series"][0]["y"]["base64"].get<std::string>().size(), 4U * 5000U);
}

TEST(Report, AMapKeepsItsCellsAndItsGaps) {
  HeatMap map{"Map",
              "",
              {{"position", "mm"}, 10.0, 5.0, 2},
              {{"speed", "rad/s"}, -1.0, 1.0, 2},
              {"torque", "Nm"},
              {0.123456, std::nan(""), -2.0, 0.0}};
  map.limit = 2.0;
  Report report("test");
  report.add(map);
  const nlohmann::json plot = plots_of(report.html())[0];
  EXPECT_EQ(plot["kind"], "map");
  EXPECT_EQ(plot["values"], nlohmann::json({0.1235, nullptr, -2.0, 0.0}));
  EXPECT_EQ(plot["x"]["count"], 2);
  EXPECT_EQ(plot["y"]["label"], "speed [rad/s]");
  map.values.pop_back();
  EXPECT_THROW(report.add(map), std::invalid_argument);
}

TEST(Report, WhatIsFoldedIsBehindItsTitle) {
  Report report("test");
  BarChart chart = sample::ladder();
  chart.folded = true;
  report.add(chart);
  const std::string html = report.html();
  const std::size_t details = html.find("<details>");
  ASSERT_NE(details, std::string::npos);
  EXPECT_LT(html.find("<summary>Ladder of errors</summary>"), html.find("as given"));
  EXPECT_LT(html.find("+ cogging"), html.find("</details>"));
}

TEST(Report, PlotsToCompareKeepTheirRangeAndTheirDashes) {
  ScatterPlot curve = sample::friction_curve();
  curve.large = true;
  curve.y_range = {-3.0, 4.0};
  curve.series[1].dashed = true;
  Report report("test");
  report.add(curve);
  const nlohmann::json plot = plots_of(report.html())[0];
  EXPECT_EQ(plot["large"], true);
  EXPECT_EQ(plot["yRange"], nlohmann::json({-3.0, 4.0}));
  EXPECT_EQ(plot["series"][1]["dashed"], true);
}

TEST(Report, RefusesSeriesThatDoNotFitTogether) {
  Report report("test");
  TimePlot traces = sample::time_plot(10);
  traces.panels[0].traces[1].values.pop_back();
  EXPECT_THROW(report.add(traces), std::invalid_argument);
  ScatterPlot curve = sample::friction_curve();
  curve.series[1].upper.pop_back();
  EXPECT_THROW(report.add(curve), std::invalid_argument);
}

TEST(Report, IsWrittenWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const std::string path = folder.path("report.html");
  const Report report = sample::report();
  report.write(path);
  std::ifstream file(path, std::ios::binary);
  const std::string written((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(written, report.html());
  EXPECT_THROW(report.write(folder.path("no such folder/report.html")), Failure);
}

}  // namespace
}  // namespace host
