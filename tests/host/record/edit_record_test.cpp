#include "host/record/edit_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"

namespace {

using testing::HasSubstr;

constexpr std::size_t kEditedRows = 400;
double speed(double t_s) { return 10.0 * std::sin(20.0 * t_s); }

host::Record sample() {
  host::Record record;
  record.path = "r.csv";
  record.sample_period_s = 0.001;
  for (std::size_t k = 0; k < kEditedRows; ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    record.t_s.push_back(t);
    record.u_V.push_back(k % 100 < 50 ? 1.0 : -1.0);
    record.x.push_back(5.0 * t);
    record.w.push_back(speed(t));
  }
  return record;
}

host::Record cut(const std::string& text, double from_s, double to_s) {
  return host::cut_record(text, "r.csv", from_s, to_s);
}

TEST(CutRecord, KeepsTheRowsBetweenTheTimesAndTheirStamps) {
  const host::Record part = cut(host::format_record(sample()), 0.1, 0.2);
  ASSERT_EQ(part.size(), 101u);
  EXPECT_DOUBLE_EQ(part.t_s.front(), 0.1);
  EXPECT_DOUBLE_EQ(part.t_s.back(), 0.2);
  EXPECT_EQ(part.w.front(), speed(0.1));
  EXPECT_THAT(part.header.at("cut"), HasSubstr("r.csv"));
  const host::Record again = cut(host::format_record(part), 0.1, 0.15);
  EXPECT_TRUE(again.header.contains("cut") && again.header.contains("cut_2")) << "the header states both cuts";
}

/// Messages recommend to cut a record at a fault, so the fault must not prevent the cut.
TEST(CutRecord, WhatIsCutOffNeedNotBeARecord) {
  std::string text = host::format_record(sample());
  const std::size_t at = text.find("\n0.3,") + 1;
  EXPECT_EQ(cut(text.substr(0, at) + "0.3,nan,x\n\n" + text.substr(at), 0.0, 0.25).size(), 251u);
  const std::string gap = text.substr(0, text.find("\n0.2,") + 1) + text.substr(text.find("\n0.25,") + 1);
  EXPECT_THROW(host::parse_record(gap, "r.csv"), host::Failure);
  EXPECT_EQ(cut(gap, 0.25, 1.0).size(), 150u);
  EXPECT_THROW(cut(gap, 0.1, 0.3), host::Failure) << "a gap within the part is still refused";
}

TEST(CutRecord, TooLittleIsRefused) {
  const std::string text = host::format_record(sample());
  EXPECT_THROW(cut(text, 0.1, 0.11), host::Failure);
  EXPECT_THROW(cut(text, 0.2, 0.1), host::Failure);
  EXPECT_THROW(cut(text, 7.0, 8.0), host::Failure);
  EXPECT_THROW(cut("", 0.0, 8.0), host::Failure);
  EXPECT_THROW(cut("# only\n# remarks", 0.0, 8.0), host::Failure);
}

TEST(ShiftChannel, LaterAndEarlierByWholeSamplesMovesBits) {
  const host::Record given = sample();
  const host::Record later = host::shift_channel(given, "w_rad_s", 0.014);
  ASSERT_EQ(later.size(), kEditedRows - 14);
  EXPECT_NEAR(later.t_s.front(), 0.014, 1e-12);
  for (std::size_t k = 0; k < later.size(); ++k) {
    EXPECT_NEAR(later.w[k], given.w[k], 1e-9);
    EXPECT_EQ(later.x[k], given.x[k + 14]);
  }
  const host::Record earlier = host::shift_channel(given, "w_rad_s", -0.014);
  ASSERT_EQ(earlier.size(), kEditedRows - 14);
  EXPECT_EQ(earlier.t_s.front(), 0.0);
  for (std::size_t k = 0; k < earlier.size(); ++k) EXPECT_NEAR(earlier.w[k], given.w[k + 14], 1e-9);
}

TEST(ShiftChannel, PartsOfASampleLieOnStraightLines) {
  const host::Record shifted = host::shift_channel(sample(), "w_rad_s", 0.0004);
  for (std::size_t k = 0; k < shifted.size(); ++k) EXPECT_NEAR(shifted.w[k], speed(shifted.t_s[k] - 0.0004), 1e-3);
  EXPECT_THAT(shifted.header.at("shifted"), testing::AllOf(HasSubstr("w_rad_s by +0.0004 s"), HasSubstr("lines")));
}

/// A command is held. Shifted by half a sample, a step between two rows becomes a row with their mean.
TEST(ShiftChannel, AHeldCommandKeepsItsMean) {
  const host::Record shifted = host::shift_channel(sample(), "u_V", 0.0005);
  const auto row = static_cast<std::size_t>(std::lround((0.05 - shifted.t_s.front()) * 1000.0));
  EXPECT_NEAR(shifted.u_V[row - 1], 1.0, 1e-9);
  EXPECT_NEAR(shifted.u_V[row], 0.0, 1e-9);
  EXPECT_NEAR(shifted.u_V[row + 1], -1.0, 1e-9);
}

TEST(ShiftChannel, UnknownChannelsAndLongShiftsAreRefused) {
  try {
    host::shift_channel(sample(), "w_rads", 0.01);
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_THAT(failure.what(), testing::AllOf(HasSubstr("w_rads"), HasSubstr("did you mean w_rad_s?")));
  }
  EXPECT_THROW(host::shift_channel(sample(), "t_s", 0.01), host::Failure);
  EXPECT_THROW(host::shift_channel(sample(), "w_rad_s", 0.39), host::Failure);
  EXPECT_THROW(host::shift_channel(sample(), "w_rad_s", 7.0), host::Failure);
}

}  // namespace
