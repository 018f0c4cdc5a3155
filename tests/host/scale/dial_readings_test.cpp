// Readings of a dial gauge: a table with play, computed here by a formula, and files as people write them.
#include "host/scale/dial_readings.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/exit_codes.hpp"

namespace {

/// Three steps forward and three back, on a table that loses `lost_um` at a reversal, with a gauge of 1 um.
std::string dial_file(double lost_um, double lead_um_per_m, unsigned seed, double travel_mm = 0.15) {
  std::mt19937 random(seed);
  std::normal_distribution<double> scatter(0.0, 0.4e-3);
  std::string text = "# Monday, gauge on the table\nx_mm,dial_mm\n";
  double table = 0.0;
  for (int k = 0; k < 24; ++k) {
    const int place = k % 6;
    const double x = travel_mm / 3.0 * (place <= 3 ? place : 6 - place);
    if (x > table + 0.5e-3 * lost_um) table = x - 0.5e-3 * lost_um;
    if (x < table - 0.5e-3 * lost_um) table = x + 0.5e-3 * lost_um;
    const double read = table * (1.0 + 1e-6 * lead_um_per_m) + scatter(random) + 3.2;
    text += fmt::format("{:.4f},{:.3f}\n", x, std::round(read * 1e3) / 1e3);
  }
  return text;
}

host::DialStudy study_of(const std::string& text) {
  return host::study_dial(host::parse_dial_readings(text, "readings.csv"));
}

TEST(DialReadings, MeasureWhatAReversalLoses) {
  int covered = 0;
  constexpr int kSeeds = 40;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const host::DialStudy study = study_of(dial_file(12.0, 0.0, seed));
    EXPECT_NEAR(study.lost_um.value, 12.0, 1.0) << seed;
    EXPECT_GT(study.lost_um.probability, 0.99);
    EXPECT_EQ(study.reversals, 7U);
    covered += study.lost_um.ci95[0] <= 12.0 && study.lost_um.ci95[1] >= 12.0;
  }
  EXPECT_GE(covered, 35) << "of 40 intervals of 95 %";
}

TEST(DialReadings, SayNothingOfAGoodTable) {
  int claimed = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) claimed += study_of(dial_file(0.0, 0.0, seed)).lost_um.probability > 0.95;
  EXPECT_LE(claimed, 2);
}

TEST(DialReadings, TellALeadErrorFromAPlay) {
  const host::DialStudy study = study_of(dial_file(6.0, 80.0, 3, 150.0));
  EXPECT_NEAR(study.lost_um.value, 6.0, 1.0);
  EXPECT_NEAR(study.lead_um_per_m.value, 80.0, 5.0);
  EXPECT_LE(study.lead_um_per_m.ci95[0], 80.0);
  EXPECT_GE(study.lead_um_per_m.ci95[1], 80.0);
}

TEST(DialReadings, WithoutAReversalKnowNothingOfIt) {
  const host::DialStudy study = study_of("x_mm,dial_mm\n0,0\n1,1\n2,2.001\n3,3\n4,4\n");
  EXPECT_EQ(study.reversals, 0U);
  EXPECT_EQ(study.lost_um.probability, 0.0);
}

TEST(DialReadings, AGaugeMayCountTheOtherWayAndInOtherUnits) {
  const std::string plain = dial_file(12.0, 0.0, 1);
  const host::DialReadings readings = host::parse_dial_readings(plain, "a.csv");
  std::string turned = "dial_um;x_m\n";
  for (std::size_t k = 0; k < readings.x_mm.size(); ++k)
    turned += fmt::format("{:.1f};{:.7f}\n", -1e3 * readings.dial_mm[k], 1e-3 * readings.x_mm[k]);
  EXPECT_NEAR(study_of(turned).lost_um.value, study_of(plain).lost_um.value, 1e-6);
}

TEST(DialReadings, NameFileLineAndRemedy) {
  const std::pair<const char*, const char*> bad[] = {
      {"", "readings.csv:0"},
      {"x_mm,reading\n0,0\n", "dial_mm"},
      {"x_mm,dial_mm\n0,0\n1,1\n", "give 4"},
      {"x_mm,dial_mm\n0,0\n1,one\n2,2\n3,3\n", "readings.csv:3"},
      {"x_mm,dial_mm\n0,0\n1\n2,2\n3,3\n", "readings.csv:3"},
      {"x_mm,dial_mm\n0,0\n1,nan\n2,2\n3,3\n", "readings.csv:3"},
      {"x_mm,dial_mm\n1,0\n1,1\n1,2\n1,3\n", "never changes"},
      {"x_mm,dial_um\n0,0\n1,1\n2,2\n3,3\n", "unit"},
  };
  for (const auto& [text, says] : bad) {
    try {
      host::parse_dial_readings(text, "readings.csv");
      ADD_FAILURE() << text;
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::bad_input);
      EXPECT_NE(std::string(failure.what()).find(says), std::string::npos) << failure.what();
    }
  }
}

}  // namespace
