// axistool circle on records of hil and on hand-made records.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/axistool/simulated_board.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Circle : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.path(name); }

  /// Two turns of 30 mm radius at 60 mm/s in one direction, optionally with a ballbar that measures a squareness error
  /// of `q_um` over the radius.
  std::string made(const std::string& name, double direction, double q_um, bool with_bar) const {
    std::string text =
        "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.002\nt_s,u_V,x_mm,x_ref_mm,y_mm,y_ref_mm";
    text += with_bar ? ",radius_mm\n" : "\n";
    unsigned noise = 12345;
    for (int k = 0; k < 3400; ++k) {
      const double angle = direction * 2.0 * 0.002 * k, x = 30.0 * std::cos(angle), y = 30.0 * std::sin(angle);
      noise = noise * 1103515245u + 12345u;
      const double part = (noise >> 16) / 65536.0 - 0.5;
      const double bar = std::hypot(x + q_um / 1e3 * std::sin(angle), y) + 3e-4 * part;
      text += std::to_string(0.002 * k) + "," + std::to_string(part) + "," + std::to_string(std::floor(x * 1e3) / 1e3) +
              "," + std::to_string(x) + "," + std::to_string(std::floor(y * 1e3) / 1e3) + "," + std::to_string(y);
      text += with_bar ? "," + std::to_string(bar) + "\n" : "\n";
    }
    return folder_.write(name, text);
  }

  static json circle(const std::string& words) {
    const ProgramRun run = run_axistool("circle " + words + " --json -", "2>/dev/null");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return json::parse(run.output);
  }
  TemporaryFolder folder_;
};

TEST_F(Circle, WhatHilWritesIsTakenAsAPair) {
  ASSERT_EQ(run_axistool("hil circle-without-friction -o " + file("hil")).exit_code, 0);
  const std::string stem = file("hil/circle-without-friction-");
  const json found = circle(stem + "x.csv " + stem + "y.csv --report " + file("page.html"));
  EXPECT_EQ(found["format"], "axis-circle/1");
  EXPECT_GT(found["iso_230_4"]["G_um"], 5.0);
  EXPECT_TRUE(found["iso_230_4"]["H_um"].is_null()) << "one direction";
  EXPECT_THAT(found["cannot_see"], Contains("squareness"));
  for (const json& cause : found["causes"]) {
    EXPECT_THAT(found["cannot_see"], Not(Contains(cause["kind"])));
    EXPECT_GE(cause["um"], cause["ci95"][0]);
    EXPECT_LE(cause["um"], cause["ci95"][1]);
    EXPECT_GT(cause["probability"], 0.5);
  }
  EXPECT_THAT(host::read_file(file("page.html")), HasSubstr("ISO 230-4"));
}

TEST_F(Circle, ABallbarShowsThatAxesAreNotSquare) {
  const json found = circle(made("ccw.csv", 1.0, 9.0, true) + " " + made("cw.csv", -1.0, 9.0, true));
  ASSERT_EQ(found["causes"].size(), 1u) << found.dump(2);
  EXPECT_EQ(found["causes"][0]["kind"], "squareness");
  EXPECT_NEAR(found["causes"][0]["um"], 9.0, 0.3);
  EXPECT_NEAR(found["causes"][0]["amount"]["value"], 300.0, 10.0);
  EXPECT_EQ(found["causes"][0]["amount"]["unit"], "um/m");
  EXPECT_NEAR(found["iso_230_4"]["Gb_um"], 9.0, 0.5);
  EXPECT_LT(found["iso_230_4"]["H_um"], 0.5);
  EXPECT_THAT(found["cannot_see"], Not(Contains("squareness")));
}

TEST_F(Circle, EncodersAloneNameNoGeometry) {
  const json found = circle(made("ccw.csv", 1.0, 9.0, false) + " " + made("cw.csv", -1.0, 9.0, false));
  EXPECT_TRUE(found["causes"].empty()) << found.dump(2);
  for (const char* kind :
       {"squareness", "scale_mismatch", "coupling", "backlash", "lateral_play", "straightness", "stick_slip"})
    EXPECT_THAT(found["cannot_see"], Contains(kind));
}

/// A slow circle whose axis y rests below 0.8 mm/s until the circle is 15 um ahead, and then jumps to it.
TEST_F(Circle, AnAxisThatSticksIsTold) {
  std::string files;
  for (const double direction : {1.0, -1.0}) {
    std::string text =
        "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.001\nt_s,u_V,x_mm,x_ref_mm,y_mm,y_ref_mm\n";
    double rest = 0.0;
    for (int k = 0; k < 34000; ++k) {
      // The reversals are not at an edge between two encoder steps.
      const double angle = direction * 0.2 * 0.001 * k;
      const double x = 0.0003 + 20.0 * std::cos(angle), y = 0.0004 + 20.0 * std::sin(angle);
      if (std::abs(y - rest) > 0.015 || std::abs(4.0 * std::cos(angle)) > 0.8) rest = y;
      text += std::to_string(0.001 * k) + ",0." + std::to_string(k % 7) + "," +
              std::to_string(std::floor(x * 1e3) / 1e3) + "," + std::to_string(x) + "," +
              std::to_string(std::floor(rest * 1e3) / 1e3) + "," + std::to_string(y) + "\n";
    }
    files += folder_.write(direction > 0.0 ? "ccw.csv" : "cw.csv", text) + " ";
  }
  const json found = circle(files);
  ASSERT_EQ(found["causes"].size(), 1u) << found.dump(2);
  EXPECT_EQ(found["causes"][0]["kind"], "stick_slip");
  EXPECT_EQ(found["causes"][0]["axis"], "y");
  EXPECT_NEAR(found["causes"][0]["um"], 30.0, 3.0);  // lag of 15 um towards either end
  EXPECT_THAT(found["cannot_see"], Not(Contains("stick_slip")));
}

/// Friction makes the motor late by up to 10 um after each reversal of x, and the table rests until the motor has
/// crossed the gap: the late motor must not be counted twice.
TEST_F(Circle, BacklashAndReversalSpikeOfOneAxisHaveTheirOwnSizes) {
  std::string files;
  for (const double direction : {1.0, -1.0}) {
    std::string text =
        "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.001\n"
        "t_s,u_V,x_mm,x_ref_mm,y_mm,y_ref_mm,radius_mm\n";
    constexpr double kGap_mm = 0.012, kDecay_s = 0.02;
    double table = 29.994;
    for (int k = 0; k < 6800; ++k) {
      const double t_s = 0.001 * k, turned = 2.0 * t_s, x = 30.0 * std::cos(turned);
      const double y = direction * 30.0 * std::sin(turned),
                   since = std::fmod(turned, std::numbers::pi) / 2.0 / kDecay_s;
      const double motor = x + std::copysign(0.010 * since * std::exp(1.0 - since), std::sin(turned));
      table = std::clamp(table, motor - 0.5 * kGap_mm, motor + 0.5 * kGap_mm);
      for (const double value : {t_s, 0.1 * (k % 7), std::floor(motor * 2e3) / 2e3, x, std::floor(y * 2e3) / 2e3, y})
        text += std::to_string(value) + ",";
      text += std::to_string(std::hypot(table, y) + 1e-4 * std::sin(1.7 * k * k)) + "\n";
    }
    files += folder_.write(direction > 0.0 ? "ccw.csv" : "cw.csv", text) + " ";
  }
  const json found = circle(files);
  ASSERT_EQ(found["causes"].size(), 2u) << found.dump(2);
  for (const json& cause : found["causes"]) {
    const bool is_gap = cause["kind"] == "backlash";
    EXPECT_EQ(cause["kind"], is_gap ? "backlash" : "reversal_spike");
    EXPECT_EQ(cause["axis"], "x");
    EXPECT_NEAR(cause["um"], is_gap ? 12.0 : 10.0, is_gap ? 0.2 : 0.5);
  }
}

/// Each row of the slow circle is the mean of 40 ms. A vibration of 27.7 Hz leaves a seventh of its amplitude there, at
/// another frequency.
TEST_F(Circle, AVibrationIsOneCauseAlsoWhereARowIsLongerThanItsPeriod) {
  std::string files;
  for (const double turn_rad_s : {0.2, 2.0}) {
    std::string text =
        "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.001\nt_s,u_V,x_mm,x_ref_mm,y_mm,y_ref_mm\n";
    for (int k = 0; k < (turn_rad_s < 1.0 ? 34000 : 7000); ++k) {
      const double t_s = 0.001 * k, x = 0.0003 + 20.0 * std::cos(turn_rad_s * t_s),
                   y = 20.0 * std::sin(turn_rad_s * t_s);
      const double seen = x + 0.003 * std::sin(2.0 * std::numbers::pi * 27.7 * t_s);
      for (const double value : {t_s, 0.1 * (k % 7), std::floor(seen * 5e3) / 5e3, x, std::floor(y * 5e3) / 5e3})
        text += std::to_string(value) + ",";
      text += std::to_string(y) + "\n";
    }
    files += folder_.write(turn_rad_s < 1.0 ? "slow.csv" : "fast.csv", text) + " ";
  }
  const json found = circle(files);
  ASSERT_EQ(found["causes"].size(), 1u) << found.dump(2);
  EXPECT_TRUE(found["minor"].empty()) << found.dump(2);
  EXPECT_NEAR(found["causes"][0]["um"], 6.0, 0.2);
}

/// The shipped ballbar scenario with other errors of the table, or its own.
class CircleOnATable : public Circle {
 protected:
  json of_table(const std::string& errors) const {
    const std::string scenarios = AXIS_TEST_DATA "/../../host/hil/scenarios/";
    std::string text = host::read_file(scenarios + "ballbar.toml");
    const std::size_t begin = text.find("squareness_um_m"), end = text.find("[ballbar]");
    if (!errors.empty()) text.replace(begin, end - begin, errors + "\n");
    const ProgramRun run = run_axistool("hil " + folder_.write("bar.toml", text) + " -o " + file("bar"));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return circle(file("bar/bar-x.csv") + " " + file("bar/bar-y.csv"));
  }

  /// Exactly these causes, with sizes within 5 % in their own units.
  static void expect_causes(const json& found, std::map<std::string, double> amounts) {
    for (const json& cause : found["causes"]) {
      const std::string name = cause["kind"].get<std::string>() + " " + cause["axis"].get<std::string>();
      ASSERT_TRUE(amounts.contains(name)) << found.dump(2);
      EXPECT_NEAR(cause["amount"]["value"], amounts[name], 0.05 * std::abs(amounts[name])) << name;
      amounts.erase(name);
    }
    EXPECT_TRUE(amounts.empty()) << amounts.begin()->first << " is missing";
  }
};

TEST_F(CircleOnATable, NamesWhatTheShippedScenarioHas) {
  // The bow of 60 um at 100 mm is 60 um * 0.35^2 at the radius.
  expect_causes(of_table(""), {{"squareness xy", 200.0}, {"straightness x", 7.35}, {"lateral_play y", 5.0}});
}

TEST_F(CircleOnATable, TellsCouplingFromSquareness) {
  expect_causes(of_table("coupling_x_um_s2_m = 20.0\nscale_x_ppm = 150.0\nscale_y_ppm = -50.0\n"),
                {{"coupling xy", 20.0}, {"scale_mismatch xy", 200.0}});
  expect_causes(of_table("coupling_y_um_s2_m = 8.0\nsquareness_um_m = -200.0\n"),
                {{"coupling xy", 8.0}, {"squareness xy", -200.0}});
}

TEST_F(Circle, SaysWhatARecordLacks) {
  const std::string jog = std::string(AXIS_TEST_DATA) + "/drive-cases/none/case-00/train-jog.csv";
  const ProgramRun alone = run_axistool("circle " + jog);
  EXPECT_EQ(alone.exit_code, 9);
  EXPECT_THAT(alone.output, HasSubstr("axis y"));
  std::string line = "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.01\nt_s,u_V,x_mm,y_mm\n";
  for (int k = 0; k < 400; ++k)
    line += std::to_string(0.01 * k) + ",0." + std::to_string(k) + "," + std::to_string(0.1 * k) + "," +
            std::to_string(0.05 * k) + "\n";
  const ProgramRun straight = run_axistool("circle " + folder_.write("line.csv", line));
  EXPECT_EQ(straight.exit_code, 8) << straight.output;
  EXPECT_THAT(straight.output, HasSubstr("no turn of a circle"));
  const std::size_t field = line.find(",0.050000");
  const ProgramRun gap = run_axistool("circle " + folder_.write("gap.csv", line.replace(field, 9, ",")));
  EXPECT_EQ(gap.exit_code, 9) << gap.output;
  EXPECT_THAT(gap.output, HasSubstr("row 2 of y_mm is not a number"));
}

/// Two axes with different loops on a board: the circles show the mismatch. Its value follows from the parameters: with
/// reference velocity only, each axis lags by its own time.
TEST_F(Circle, ABoardMakesTheCircles) {
  const std::string model = AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml";
  const SimulatedBoardProcess board(folder_.path(""), {"--x", model, "--y", model});
  std::string drive = host::read_file(model);
  ASSERT_EQ(board.run("set-params host.timeout=5").exit_code, 0);
  for (const char* axis : {"x", "y"}) {
    drive.replace(drive.find("name = \"") + 8, 1, axis);
    const std::string own = folder_.write(std::string(axis) + ".toml", drive),
                      params = file(std::string(axis) + "-p.toml");
    ASSERT_EQ(
        run_axistool("design " + own + " --feedforward velocity --fc " + (*axis == 'x' ? "35" : "20") + " -o " + params)
            .exit_code,
        0);
    ASSERT_EQ(board.run("set-params " + params).exit_code, 0);
    ASSERT_EQ(board.run(std::string("home ") + axis + " --here").exit_code, 0);
  }
  EXPECT_EQ(board.run("circle --yes").exit_code, 2) << "no folder";
  EXPECT_EQ(board.run("circle --yes --feeds 400 -o " + file("fast")).exit_code, 8);
  const ProgramRun run = board.run("circle --yes --radius 15 --feeds 30,90 -o " + file("made") + " --json " +
                                   file("found.json") + " --report " + file("page.html"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json found = json::parse(host::read_file(file("found.json")));
  ASSERT_FALSE(found["causes"].empty()) << found.dump(2);
  EXPECT_EQ(found["causes"][0]["kind"], "servo_mismatch") << found.dump(2);
  EXPECT_FALSE(found["iso_230_4"]["H_um"].is_null()) << "both ways";
  for (const char* name : {"ccw-30", "cw-30", "ccw-90", "cw-90"})
    EXPECT_GT(host::read_file(file("made/") + name + ".csv").size(), 1000u);
}

}  // namespace
