#include "host/evidence/log_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "host/model/model_file.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

using host::LogFaultKind;
namespace fs = std::filesystem;

void shift_later(std::vector<double>& values, std::size_t samples) {
  std::rotate(values.begin(), values.end() - static_cast<std::ptrdiff_t>(samples), values.end());
  std::fill_n(values.begin(), samples, values[samples]);
}

class LogFaults : public testing::Test {
 protected:
  /// The only fault that is found; null (and a test failure) if their number is not one.
  void expect_only(LogFaultKind kind, const std::string& channel, double size, double tolerance) {
    const auto faults = host::log_faults(record, model);
    ASSERT_EQ(faults.size(), 1u) << (faults.empty() ? "" : faults[0].message);
    EXPECT_EQ(faults[0].kind, kind) << faults[0].message;
    EXPECT_EQ(faults[0].channel, channel);
    EXPECT_NEAR(faults[0].size, size, tolerance) << faults[0].message;
    EXPECT_EQ(host::log_faults_json(faults)[0]["kind"], host::log_fault_name(kind));
  }
  host::Record record = HandMade::record();
  sim::DriveDescription model = HandMade::model();
};

TEST_F(LogFaults, NoneInASoundRecord) { EXPECT_TRUE(host::log_faults(record, model).empty()); }

/// Catches a noise floor of zero and a model of another machine without a message.
TEST_F(LogFaults, OfADataSheetAreSaidAndEndNothing) {
  model.data.encoder_resolution = 0.0;
  expect_only(LogFaultKind::no_encoder, "x_mm", 0.002, 1e-9);
  EXPECT_FALSE(host::log_faults(record, model)[0].fatal);
  for (std::size_t k = 0; k < record.size(); ++k) record.x[k] += 1e-4 * std::sin(1.3 * static_cast<double>(k));
  EXPECT_TRUE(host::log_faults(record, model).empty()) << "positions without counts";
  model = HandMade::model();
  record = HandMade::record();
  record.drive = "y";
  expect_only(LogFaultKind::other_drive, "x_mm", 0.0, 1e-9);
  record.drive = model.name;
  EXPECT_TRUE(host::log_faults(record, model).empty());
}

TEST_F(LogFaults, NoneWhereInertiaAndFrictionDiffer) {
  model.find("inertia")->parameters["J"] *= 1.5;
  model.find("coulomb")->parameters["positive"] *= 0.6;
  EXPECT_TRUE(host::log_faults(record, model).empty());
}

TEST_F(LogFaults, CounterRunsOver) {
  const double wrap = 8192 * model.data.encoder_resolution;
  for (double& x : record.x) x -= wrap * std::floor(x / wrap);
  // The motion crosses a multiple of 16.384 mm many times; the first crossing is upward.
  expect_only(LogFaultKind::integer_wrap, "x_mm", -wrap, 2 * model.data.encoder_resolution);
}

TEST_F(LogFaults, AnAngleBeginsAgainAfterEachTurn) {
  const double turn = 2.0 * M_PI * model.data.lead;
  for (double& x : record.x) x = std::remainder(x, turn);
  expect_only(LogFaultKind::integer_wrap, "x_mm", -turn, 0.01 * turn);
}

TEST_F(LogFaults, TwoNewZerosAreNoAngle) {
  // The same distance, but the axis moves beyond it.
  for (std::size_t k = 700; k < record.size(); ++k) record.x[k] -= k < 1200 ? 17.3 : 34.6;
  const auto faults = host::log_faults(record, model);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults.front().kind, LogFaultKind::new_zero);
}

TEST_F(LogFaults, NewZeroAtStandstill) {
  for (std::size_t k = 2300; k < record.size(); ++k) record.x[k] -= 17.3;
  expect_only(LogFaultKind::new_zero, "x_mm", -17.3, 1e-6);
}

TEST_F(LogFaults, SamplesDroppedUnderSteadyTimeStamps) {
  // Each is five samples of 50 rad/s * 1.6 mm/rad * 1 ms.
  for (auto* channel : {&record.u_V, &record.x, &record.w})
    channel->erase(channel->begin() + 1000, channel->begin() + 1005);
  record.t_s.resize(record.x.size());
  expect_only(LogFaultKind::dropped_samples, "x_mm", 5.0, 0.0);
}

TEST_F(LogFaults, SpeedDerivedFromPosition) {
  for (std::size_t k = 1; k < record.size(); ++k)
    record.w[k] = (record.x[k] - record.x[k - 1]) / (model.data.lead * record.sample_period_s);
  const auto faults = host::log_faults(record, model);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0].kind, LogFaultKind::derived_channel);
}

/// The current that a good amplifier makes, measured with noise of a thousandth, is no copy of the command; a computed
/// one is, even if both were rounded when they were written.
TEST_F(LogFaults, ACurrentComputedFromTheCommandIsACopyAndAMeasuredOneIsNot) {
  const auto rounded = [](double value, double step) { return step * std::round(value / step); };
  for (double& u : record.u_V) u = rounded(u, 1e-4);
  const auto [low, high] = std::ranges::minmax(record.u_V);
  for (const bool is_measured : {false, true}) {
    record.i_A.clear();
    for (std::size_t k = 0; k < record.u_V.size(); ++k) {
      const double noise = is_measured ? 3e-4 * (high - low) * std::sin(1.7 * static_cast<double>(k * k)) : 0.0;
      record.i_A.push_back(rounded(6.2 * (record.u_V[k] + noise), 1e-4));
    }
    if (is_measured)
      EXPECT_TRUE(host::log_faults(record, model).empty());
    else
      expect_only(LogFaultKind::scaled_copy, "i_A", 6.2, 1e-3);
  }
}

TEST_F(LogFaults, CommandOfTheWrongSign) {
  for (double& u_V : record.u_V) u_V = -u_V;
  expect_only(LogFaultKind::command_sign, "u_V", -1.0, 0.0);
}

TEST_F(LogFaults, CommandInAnotherUnit) {
  model.data.dac_limit_V = 1000.0;
  for (double& u_V : record.u_V) u_V *= 100.0;
  expect_only(LogFaultKind::command_scale, "u_V", 100.0, 5.0);
}

TEST_F(LogFaults, PositionInAnotherUnit) {
  record.w.clear();
  model.data.encoder_resolution /= 25.4;
  for (double& x : record.x) x /= 25.4;  // inches
  expect_only(LogFaultKind::position_scale, "x_mm", 1.0 / 25.4, 1e-3);
}

TEST_F(LogFaults, TachometerLateByWholeSamples) {
  shift_later(record.w, 4);
  expect_only(LogFaultKind::time_shift, "w_rad_s", 0.004, 1e-9);
}

/// As from a logger that merges channels with two clocks.
TEST_F(LogFaults, TachometerLateByPartsOfASample) {
  for (std::size_t k = record.size() - 1; k >= 9; --k) record.w[k] = 0.4 * record.w[k - 8] + 0.6 * record.w[k - 9];
  const auto faults = host::log_faults(record, model);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].kind, LogFaultKind::time_shift);
  EXPECT_NEAR(faults[0].size, 0.0086, 0.0001);
  EXPECT_FALSE(faults[0].fatal);
}

/// As from a busy computer that interpolates the log while the axis moves on.
TEST_F(LogFaults, RowsThatComeLateAreNoNewZero) {
  for (std::size_t k = 1001; k < 1007; ++k) record.x[k] = record.x[1000] + 0.01 * static_cast<double>(k - 1000);
  const auto faults = host::log_faults(record, model);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].kind, LogFaultKind::uneven_clock) << faults[0].message;
  EXPECT_NEAR(faults[0].t_s, 1.007, 1e-9);
  EXPECT_FALSE(faults[0].fatal);
}

/// As from a controller that reads its position every tenth sample.
TEST_F(LogFaults, APositionThatIsHeldOverSomeRowsIsNoNewZero) {
  record.w.clear();
  for (std::size_t k = 0; k < record.size(); ++k) record.x[k] = record.x[k - k % 10];
  for (const host::LogFault& fault : host::log_faults(record, model))
    EXPECT_NE(fault.kind, LogFaultKind::new_zero) << fault.message;
}

TEST_F(LogFaults, TachometerFilterIsPhysics) {
  const double keep = std::exp(-1.0 / 3.0);  // 3 ms
  double held = 0.0;
  for (double& w : record.w) w = held = keep * held + (1.0 - keep) * w;
  EXPECT_TRUE(host::log_faults(record, model).empty());
}

TEST_F(LogFaults, AnswerBeforeTheCommand) {
  shift_later(record.u_V, 5);
  expect_only(LogFaultKind::time_shift, "u_V", 0.005, 1e-9);
}

TEST_F(LogFaults, DeadTimeIsPhysics) {
  shift_later(record.x, 2);
  shift_later(record.w, 2);
  EXPECT_TRUE(host::log_faults(record, model).empty());
}

TEST(LogFaultsOfDrives, NoneInRecordsOfAnIndependentPlant) {
  std::size_t seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(AXIS_TEST_DATA) / "drive-cases")) {
    if (entry.path().extension() != ".csv") continue;
    const sim::DriveDescription model = host::read_model((entry.path().parent_path() / "model.toml").string());
    host::Record record = host::read_record(entry.path().string());
    host::adapt_to(record, model.data);
    const auto faults = host::log_faults(record, model);
    EXPECT_TRUE(faults.empty()) << entry.path() << ": " << faults[0].message;
    ++seen;
  }
  EXPECT_GT(seen, 0u);
}

}  // namespace
