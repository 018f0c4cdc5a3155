// Opens a report in headless Chromium and uses it with the mouse, as a reader does.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "host/diagnose/diagnosis_report.hpp"
#include "tests/host/diagnose/drive_case.hpp"
#include "tests/host/report/sample_report.hpp"
#include "tests/host/temporary_folder.hpp"

namespace host {
namespace {

/// Runs after the scripts of the report: checks pixels, drags, checks the ranges, and writes the results into the page.
constexpr const char* visitor_script = R"(
<pre id="seen"></pre><script>
(async function () {
  const seen = { charts: axisCharts.length, title: document.title, fetched: performance.getEntriesByType("resource").length };
  const pause = () => new Promise((resolve) => setTimeout(resolve, 200));
  const near = (a, b) => Math.abs(a - b) < 40;
  function pixelsOf(chart, colour) {
    const rgb = [1, 3, 5].map((k) => parseInt(colour.substr(k, 2), 16));
    let count = 0;
    for (const canvas of chart.graphDiv.querySelectorAll("canvas")) {
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
      copy.drawImage(canvas, 0, 0);
      const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
      for (let k = 0; k < data.length; k += 4)
        if (data[k + 3] > 128 && near(data[k], rgb[0]) && near(data[k + 1], rgb[1]) && near(data[k + 2], rgb[2])) count++;
    }
    return count;
  }
  function mouse(chart, type, x, extra) {
    const target = [...chart.graphDiv.querySelectorAll("canvas")].pop();
    const box = target.getBoundingClientRect();
    target.dispatchEvent(new MouseEvent(type, Object.assign({ bubbles: true, cancelable: true, view: window, button: 0,
      clientX: box.left + x, clientY: box.top + 60 }, extra)));
  }
  const ranges = () => axisCharts.slice(0, 2).map((chart) => chart.xAxisRange());
  seen.pixels = axisCharts.map((chart) => chart.getColors().map((colour) => pixelsOf(chart, colour)));
  seen.mapColours = [...document.querySelectorAll(".map canvas")].map(function (canvas) {
    const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    const colours = new Set();
    for (let k = 0; k < data.length; k += 4) colours.add(data[k] * 65536 + data[k + 1] * 256 + data[k + 2]);
    return colours.size;
  });
  seen.rowsAtFirst = axisCharts[0].numRows();
  seen.whole = ranges();
  mouse(axisCharts[0], "mousedown", 300);
  mouse(axisCharts[0], "mousemove", 320);
  mouse(axisCharts[0], "mousemove", 340);
  mouse(axisCharts[0], "mouseup", 340);
  await pause();
  seen.zoomed = ranges();
  seen.expected = [300, 340].map((x) => {
    const area = axisCharts[0].getArea();
    return seen.whole[0][0] + ((x - area.x) / area.w) * (seen.whole[0][1] - seen.whole[0][0]);
  });
  const times = [];
  for (let row = 0; row < axisCharts[0].numRows(); row++) times.push(axisCharts[0].getValue(row, 0));
  seen.rowsInside = times.filter((t) => t >= seen.zoomed[0][0] && t <= seen.zoomed[0][1]).length;
  mouse(axisCharts[1], "mousemove", 350);
  await pause();
  seen.cursor = axisCharts.slice(0, 2).map((chart) => chart.getSelection() >= 0);
  seen.readings = document.querySelectorAll("#plot-0 .at").length;
  const shift = { shiftKey: true };
  mouse(axisCharts[1], "mousedown", 300, shift);
  mouse(axisCharts[1], "mousemove", 320, shift);
  mouse(axisCharts[1], "mousemove", 350, shift);
  mouse(axisCharts[1], "mouseup", 350, shift);
  await pause();
  seen.panned = ranges();
  mouse(axisCharts[1], "dblclick", 350);
  await pause();
  seen.reset = ranges();
  document.getElementById("seen").textContent = encodeURIComponent(JSON.stringify(seen));
})();
</script></body>)";

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Reverses encodeURIComponent, by which the page protects its results from the escapes of HTML.
std::string decoded(const std::string& text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '%') {
      plain += static_cast<char>(std::stoi(text.substr(at + 1, 2), nullptr, 16));
      at += 2;
    } else {
      plain += text[at];
    }
  }
  return plain;
}

class Browser : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "chromium is not installed: the report was not opened in a browser";
    }
  }

  /// The page after `visitor_script`; the messages of the browser are in `log_`.
  std::string visit(std::string html, const char* script = visitor_script, const char* settings = "") {
    html.replace(html.rfind("</body>"), 7, script);
    folder_.write("report.html", html);
    const std::string command = fmt::format(
        "timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
        "--disable-background-networking --disable-component-update --disable-sync --disable-dev-shm-usage "
        "--window-size=1280,1000 --enable-logging=stderr --user-data-dir={0}/profile --virtual-time-budget=20000 {1} "
        "--dump-dom file://{0}/report.html >{0}/dom.html 2>{0}/log.txt </dev/null",
        folder_.path(""), settings);
    EXPECT_EQ(std::system(command.c_str()), 0) << content_of(folder_.path("log.txt"));
    log_ = content_of(folder_.path("log.txt"));
    return content_of(folder_.path("dom.html"));
  }

  /// What `script` saw on the page. On a busy machine the browser's virtual time can run out before a frame is drawn,
  /// which ends the script early; a page whose script fails does so every time.
  nlohmann::json seen_on(const std::string& html, const char* script = visitor_script, const char* settings = "") {
    nlohmann::json seen;
    for (int attempt = 0; attempt < 5 && seen.is_null(); ++attempt) seen = seen_in(visit(html, script, settings));
    return seen;
  }

  static nlohmann::json seen_in(const std::string& page) {
    const std::string mark = "<pre id=\"seen\">";
    const std::size_t begin = page.rfind(mark);
    const std::size_t end = page.find("</pre>", begin);
    if (begin == std::string::npos || end == begin + mark.size()) return nullptr;
    std::string text = page.substr(begin + mark.size(), end - begin - mark.size());
    return nlohmann::json::parse(decoded(text));
  }

  TemporaryFolder folder_;
  std::string log_;
};

TEST_F(Browser, DrawsZoomsPansAndSharesTheCursorWithoutConsoleMessages) {
  constexpr std::size_t samples = 60'000;
  const nlohmann::json seen = seen_on(sample::report(samples).html());
  EXPECT_EQ(log_.find("CONSOLE"), std::string::npos) << log_;
  ASSERT_TRUE(seen.is_object()) << "the page's scripts did not run to their end\n" << log_;

  EXPECT_EQ(seen["charts"], 4);
  EXPECT_EQ(seen["fetched"], 0);
  EXPECT_THAT(seen["title"].get<std::string>(), testing::StartsWith("Drive </script><script>"))
      << "user text is shown in the title as text";
  for (const nlohmann::json& chart : seen["pixels"]) {
    for (const nlohmann::json& pixels : chart) EXPECT_GT(pixels.get<int>(), 30) << seen["pixels"];
  }

  // Drawn with fewer rows than samples. Zooming in shows every sample.
  EXPECT_LT(seen["rowsAtFirst"].get<int>(), 10'000);
  const double from_s = seen["zoomed"][0][0];
  const double to_s = seen["zoomed"][0][1];
  const double pixel_s = 60.0 / 1000.0;
  EXPECT_NEAR(from_s, seen["expected"][0].get<double>(), 2.0 * pixel_s);
  EXPECT_NEAR(to_s, seen["expected"][1].get<double>(), 2.0 * pixel_s);
  EXPECT_EQ(seen["zoomed"][0], seen["zoomed"][1]) << "the stacked panels zoom together";
  EXPECT_NEAR(seen["rowsInside"].get<double>(), (to_s - from_s) * 1000.0, 2.0);

  EXPECT_EQ(seen["cursor"], nlohmann::json::array({true, true})) << "the cursor is shared";
  EXPECT_EQ(seen["readings"], 2);

  EXPECT_LT(seen["panned"][1][0].get<double>(), from_s) << "dragging to the right shows earlier samples";
  EXPECT_NEAR(seen["panned"][1][1].get<double>() - seen["panned"][1][0].get<double>(), to_s - from_s, 1e-6);
  EXPECT_EQ(seen["panned"][0], seen["panned"][1]);
  EXPECT_EQ(seen["reset"], seen["whole"]);
}

TEST_F(Browser, ADiagnosisOfThreeSecondsIsDrawnWhole) {
  const DriveCase shipped("pairs/case-00");  // validated with 3 s of motion
  std::vector<const Record*> train, validate;
  for (const Record& record : shipped.train) train.push_back(&record);
  for (const Record& record : shipped.validate) validate.push_back(&record);
  Diagnosis diagnosis(prepare_sets(shipped.model, train, validate));
  diagnosis.where = error_regions(diagnosis.base, diagnosis.validation);
  const std::string path = folder_.path("diagnosis.html");
  write_diagnosis_report(diagnosis, "model.toml", path);
  const nlohmann::json seen = seen_on(content_of(path));
  EXPECT_EQ(log_.find("CONSOLE"), std::string::npos) << log_;
  ASSERT_TRUE(seen.is_object()) << "the page's scripts did not run to their end\n" << log_;
  // Residual over speed, period, travel, acceleration and time; that of the tachometer over speed and acceleration;
  // speed, its error, position error.
  EXPECT_EQ(seen["charts"], 10);
  ASSERT_EQ(seen["mapColours"].size(), 1U) << "over position and speed";
  EXPECT_GT(seen["mapColours"][0].get<int>(), 50);
  // The last curve is on top. For a tachometer that no effect concerns, both curves are equal.
  for (const nlohmann::json& chart : seen["pixels"]) EXPECT_GT(chart.back().get<int>(), 30) << seen["pixels"];
}

/// The page on a dark screen, and as a screen reader presents it.
constexpr const char* dark_script = R"(
<pre id="seen"></pre><script>
  const light = (colour) => colour.match(/[\d.]+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0) / 765;
  document.getElementById("seen").textContent = encodeURIComponent(JSON.stringify({
    ground: light(getComputedStyle(document.body).backgroundColor),
    figure: light(getComputedStyle(document.querySelector("figure")).backgroundColor),
    ink: light(getComputedStyle(document.body).color),
    measured: axisCharts[0].getColors()[0],
    spoken: document.querySelector("[role=img]").getAttribute("aria-label"),
  }));
</script></body>)";

TEST_F(Browser, ADarkScreenGetsADarkPageThatTellsWhatItShows) {
  Report report("Dark");
  report.add(TimePlot{"", "", {0.0, 1.0}, {{"speed", "rad/s", {{"measured", SeriesRole::measured, {-2.0, 3.0}}}}}, {}});
  const nlohmann::json seen = seen_on(report.html(), dark_script, "--blink-settings=preferredColorScheme=0");
  ASSERT_TRUE(seen.is_object()) << log_;
  EXPECT_LT(seen["ground"].get<double>(), 0.2);
  EXPECT_LT(seen["figure"].get<double>(), 0.2);
  EXPECT_GT(seen["ink"].get<double>(), 0.8);
  EXPECT_EQ(seen["measured"], "#b4c0cc") << "lines are lighter on a dark screen";
  EXPECT_EQ(seen["spoken"], "speed [rad/s] over time: measured from -2 to 3");
}

/// Scales of x and y in units per pixel: as drawn, zoomed by a drag along x, reset, and in a narrower frame.
constexpr const char* plane_script = R"(
<pre id="seen"></pre><script>
(async function () {
  const plane = axisCharts[0], canvas = [...plane.graphDiv.querySelectorAll("canvas")].pop(), seen = [];
  function look() {
    const area = plane.getArea(), x = plane.xAxisRange(), y = plane.yAxisRange();
    seen.push({ width: area.w, scales: [(x[1] - x[0]) / area.w, (y[1] - y[0]) / area.h], x: x, y: y });
  }
  function mouse(type, x) {
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new MouseEvent(type, { bubbles: true, cancelable: true, view: window, button: 0,
      clientX: box.left + x, clientY: box.top + 60 }));
  }
  look();
  for (const [type, x] of [["mousedown", 140], ["mousemove", 160], ["mousemove", 190], ["mouseup", 190]]) mouse(type, x);
  look();
  for (const type of ["mousedown", "mouseup", "dblclick"]) mouse(type, 190);
  look();
  document.querySelector("main").style.width = "260px";
  for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
  look();
  document.getElementById("seen").textContent = encodeURIComponent(JSON.stringify(seen));
})();
</script></body>)";

TEST_F(Browser, APlaneKeepsAUnitOfXAsLongAsAUnitOfY) {
  Report report("Plane");
  ScatterPlot plane{"",
                    "",
                    {"x", "mm"},
                    {"y", "mm"},
                    {{"path", SeriesRole::model, SeriesStyle::points, {0, 70, 35}, {0, 0, 35}, {}, {}}}};
  plane.equal_scales = true;
  report.add(plane);
  for (const char* screen : {"--window-size=1280,1000", "--window-size=390,844"}) {
    SCOPED_TRACE(screen);
    const nlohmann::json seen = seen_on(report.html(), plane_script, screen);
    EXPECT_EQ(log_.find("CONSOLE"), std::string::npos) << log_;
    ASSERT_TRUE(seen.is_array()) << log_;
    ASSERT_EQ(seen.size(), 4U);
    for (const nlohmann::json& look : seen) {
      EXPECT_NEAR(look["scales"][0].get<double>(), look["scales"][1].get<double>(), 1e-9) << seen.dump(1);
    }
    EXPECT_LT(seen[1]["scales"][0], seen[0]["scales"][0]) << "the drag zooms in";
    EXPECT_EQ(seen[2], seen[0]) << "a double click shows the whole again";
    EXPECT_LT(seen[3]["width"], seen[0]["width"]);
    for (const nlohmann::json& look : {seen[0], seen[3]}) {
      EXPECT_LT(look["x"][0], 0.0);
      EXPECT_GT(look["x"][1], 70.0);
    }
  }
}

TEST_F(Browser, AnEmptyReportIsStillAPage) {
  const std::string page = visit(Report("Nothing yet").html());
  EXPECT_NE(page.find("<h1>Nothing yet</h1>"), std::string::npos);
}

}  // namespace
}  // namespace host
