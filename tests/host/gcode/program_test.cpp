// G-code programs against geometry calculated by hand.
#include "host/gcode/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "host/exit_codes.hpp"

namespace {

using testing::HasSubstr;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::filesystem::path> programs(bool bad) {
  std::vector<std::filesystem::path> found;
  for (const auto& one : std::filesystem::directory_iterator(AXIS_TEST_DATA "/gcode"))
    if (one.path().extension() == ".ngc" && one.path().filename().string().starts_with("bad-") == bad)
      found.push_back(one.path());
  std::ranges::sort(found);
  return found;
}
std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.stem().string();
  std::ranges::replace(name, '-', '_');
  return name;
}

host::GcodeProgram read(const std::string& text, std::size_t axes = 2) {
  host::GcodeMachine machine;
  machine.axes = axes;
  return host::read_gcode(text, "part.ngc", host::PathPoint::Zero(), machine);
}
std::string refusal(const std::string& text, std::size_t axes = 2) {
  try {
    read(text, axes);
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    return failure.what();
  }
  return "taken";
}

class Program : public testing::TestWithParam<std::filesystem::path> {};
INSTANTIATE_TEST_SUITE_P(Good, Program, testing::ValuesIn(programs(false)), name_of);

/// Catches an arc on the wrong side or in the wrong direction, an ignored unit, and increments read as positions.
TEST_P(Program, EndsWhereGeometrySaysAndIsAsLong) {
  const std::string text = text_of(GetParam());
  std::istringstream header(text);
  std::string semicolon, word;
  host::PathPoint end;
  double length = 0.0;
  ASSERT_TRUE(header >> semicolon >> word >> end.x() >> end.y() >> end.z() && word == "end");
  ASSERT_TRUE(header >> semicolon >> word >> length && word == "length");
  const host::GcodeProgram program = read(text);
  double sum = 0.0;
  host::PathPoint at = host::PathPoint::Zero();
  for (const host::PathMove& move : program.moves) {
    if (move.kind != host::PathMoveKind::motion) continue;
    EXPECT_LT((move.curve.begin() - at).norm(), 1e-9) << "a jump before line " << move.line;
    at = move.curve.end();
    sum += move.curve.length();
  }
  EXPECT_LT((at - end).norm(), 1e-5) << at.transpose();
  EXPECT_NEAR(sum, length, 2e-3 + 1e-6 * length);
}

class BadProgram : public testing::TestWithParam<std::filesystem::path> {};
INSTANTIATE_TEST_SUITE_P(Bad, BadProgram, testing::ValuesIn(programs(true)), name_of);

TEST_P(BadProgram, IsRefusedWithItsLine) {
  const std::string text = text_of(GetParam());
  std::istringstream header(text);
  std::string semicolon, error, word;
  std::size_t line = 0;
  ASSERT_TRUE(header >> semicolon >> error >> line && std::getline(header >> std::ws, word));
  EXPECT_THAT(refusal(text), HasSubstr("part.ngc:" + std::to_string(line) + ": "));
  EXPECT_THAT(refusal(text), HasSubstr(word));
}

TEST(Gcode, HasFeedsInUnitsAMinute) {
  EXPECT_NEAR(read("F600 G1 X1").moves.at(0).feed_mm_s, 10.0, 1e-12);
  EXPECT_NEAR(read("G20 F60 G1 X1").moves.at(0).feed_mm_s, 25.4, 1e-12);
  EXPECT_NEAR(read("G1 F60 X1\nX2 F120").moves.at(1).feed_mm_s, 2.0, 1e-12);
}

TEST(Gcode, HasAnOverrideForFeedsAndOneForRapids) {
  host::GcodeMachine machine;
  machine.feed_share = 1.2;
  machine.rapid_share = 0.25;
  machine.fastest_mm_s = host::PathPoint(250.0, 100.0, 1.0);  // Z does not move
  const auto moves = host::read_gcode("G1 X10 F600\nG0 X40\nG0 Y30\nG0 X0 Y0\nG2 X10 Y10 I10\n", "part.ngc",
                                      host::PathPoint::Zero(), machine)
                         .moves;
  ASSERT_EQ(moves.size(), 5u);
  EXPECT_DOUBLE_EQ(moves[0].feed_mm_s, 12.0);
  EXPECT_DOUBLE_EQ(moves[1].feed_mm_s, 0.25 * 250.0);
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 0.25 * 100.0);
  EXPECT_NEAR(moves[3].feed_mm_s, 0.25 * 50.0 / 0.3, 1e-9) << "40 mm and 30 mm, Y at its limit for 0.3 s";
  EXPECT_DOUBLE_EQ(moves[4].feed_mm_s, 12.0);
}

TEST(Gcode, TellsTheLinesOfItsRapids) {
  const host::GcodeProgram program = read("G0 X1\nG1 F60 X2\nY2\nG0 X0\n(a)\nY0\nG28 X3\nG1 X4\n");
  EXPECT_EQ(program.rapid_lines, (std::vector<std::size_t>{1, 4, 6, 7}));
}

TEST(Gcode, ToleranceIsOfTheMovesThatFollowIt) {
  const auto moves = read("G1 F60 X1\nG64 P0.02\nX2\nG64\nX3\nG61\nX4\nG20 G64 P0.001\nX5").moves;
  ASSERT_EQ(moves.size(), 5u);
  EXPECT_EQ(moves[0].tolerance_mm, 0.0);
  EXPECT_EQ(moves[1].tolerance_mm, 0.02);
  EXPECT_EQ(moves[2].tolerance_mm, 0.05);
  EXPECT_EQ(moves[3].tolerance_mm, 0.0);
  EXPECT_NEAR(moves[4].tolerance_mm, 0.0254, 1e-12);
}

TEST(Gcode, HelixRisesEvenlyWhereThereIsAThirdAxis) {
  const auto moves = read("F600 G3 X0 Y20 Z6 I0 J10", 3).moves;
  ASSERT_EQ(moves.size(), 1u);
  EXPECT_NEAR(moves[0].curve.length(), std::hypot(10.0 * std::numbers::pi, 6.0), 1e-9);
  EXPECT_NEAR(moves[0].curve.at(moves[0].curve.length() / 2).point.z(), 3.0, 1e-9);
}

TEST(Gcode, HasFourKindsOfProbingMoves) {
  const host::GcodeProgram program = read("F300 G38.2 X10\nG38.3 X20\nY5\nG38.4 X15\nG0 X0\nG38.5 X-5\n");
  ASSERT_EQ(program.probes.size(), 5u);
  for (const auto& [probe, move, tenths] : {std::tuple{0, 0, 2}, {1, 1, 3}, {2, 2, 3}, {3, 3, 4}, {4, 5, 5}}) {
    const host::GcodeProbe& one = program.probes[static_cast<std::size_t>(probe)];
    EXPECT_EQ(one.move, static_cast<std::size_t>(move));
    EXPECT_EQ(one.tenths(), tenths) << "G38 is modal, as G1 is";
    EXPECT_EQ(program.moves[one.move].kind, host::PathMoveKind::probe);
    EXPECT_EQ(program.moves[one.move].feed_mm_s, 5.0);
  }
}

/// After a probe's contact the program continues: absolute positions are unchanged, increments count from the contact.
TEST(Gcode, GoesOnFromWhereAProbeEnded) {
  host::GcodeMachine machine;
  machine.probed = {host::PathPoint(4.25, 0.0, 0.0)};
  const auto program = host::read_gcode("F300\nG38.2 X10\nG1 Y2\nG91 G0 X-1\nG38.2 X3\nG90 G0 X0\n", "part.ngc",
                                        host::PathPoint::Zero(), machine);
  ASSERT_EQ(program.moves.size(), 5u);
  EXPECT_EQ(program.moves[0].curve.end().x(), 10.0) << "the probe may go so far";
  EXPECT_EQ(program.moves[1].curve.begin().x(), 4.25);
  EXPECT_EQ(program.moves[1].curve.end(), host::PathPoint(4.25, 2.0, 0.0));
  EXPECT_EQ(program.moves[2].curve.end().x(), 3.25);
  EXPECT_EQ(program.moves[3].curve.end().x(), 6.25);
  EXPECT_EQ(program.moves[4].curve.begin().x(), 6.25) << "not probed yet: as if nothing were there";
}

/// Moves after a probing move that has not run cannot be checked, because its end is unknown.
TEST(Gcode, IsNotRefusedForWhereAProbeMightEnd) {
  EXPECT_EQ(refusal("F300 G38.3 X10\nG38.3 X10\n"), "taken");
  host::GcodeMachine machine;
  machine.probed = {host::PathPoint(10.0, 0.0, 0.0)};
  EXPECT_THROW(host::read_gcode("F300 G38.3 X10\nG38.3 X10\n", "part.ngc", host::PathPoint::Zero(), machine),
               host::Failure);
}

TEST(Gcode, SaysWhetherItNeedsToKnowWhereItIs) {
  EXPECT_FALSE(read("G91 G1 F60 X1 Y1\nG2 X1 Y1 I1").is_absolute);
  EXPECT_TRUE(read("G1 F60 X1").is_absolute);
  EXPECT_TRUE(read("G91 G28").is_absolute);
}

/// Catches a plan that needs gigabytes for two lines.
TEST(BoundedProgram, LastsAndHoldsNoMoreThanAMachineDoes) {
  EXPECT_THAT(refusal("G21 G91\nF1\nG1 X100000\nM2\n"), HasSubstr("part.ngc:3: the program lasts longer than 10 h"));
  EXPECT_THAT(refusal("G4 P20000\nG4 P20000\n"), HasSubstr("part.ngc:2: the program lasts longer than 10 h"));
  std::string many = "G91 F1000\n";
  for (int k = 0; k < 200'001; ++k) many += "G1X1\n";
  EXPECT_THAT(refusal(many), HasSubstr("part.ngc:200002: the program has more than 200000 moves"));
}

}  // namespace
