#include "host/compare/tracking_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/exit_codes.hpp"

namespace {

constexpr double kCoggingPeriod_mm = 2.5, kLag_s = 0.004, kDirection_mm = 0.003, kCogging_mm = 0.002;

/// A table that moves back and forth 5 ms late, lags by 3 µm after each reversal, and has a ripple every 2.5 mm.
host::Record sample() {
  host::Record record;
  record.path = "r.csv";
  record.sample_period_s = 0.001;
  for (int k = 0; k < 8000; ++k) {
    const double t = 1e-3 * k, angle = 2.0 * std::numbers::pi * 0.5 * t;
    const double x = 20.0 * (1.0 - std::cos(angle)), v = 20.0 * std::numbers::pi * std::sin(angle);
    record.t_s.push_back(t);
    record.x_ref.push_back(x);
    record.x.push_back(x - kLag_s * v -
                       kDirection_mm * (v > 0.0   ? 1.0
                                        : v < 0.0 ? -1.0
                                                  : 0.0) -
                       kCogging_mm * std::sin(2.0 * std::numbers::pi * x / kCoggingPeriod_mm));
  }
  return record;
}

const host::TrackingPart& part(const host::TrackingError& error, const std::string& with) {
  for (const host::TrackingPart& part : error.parts)
    if (part.with == with) return part;
  throw std::runtime_error(with);
}

TEST(TrackingError, TellsLagFrictionAndPeriodApart) {
  const host::TrackingError error = host::tracking_error(sample());
  EXPECT_EQ(error.channel, "x_mm");
  EXPECT_NEAR(part(error, "speed").coefficient, kLag_s, 2e-5);
  EXPECT_GT(part(error, "speed").share, 0.9);
  EXPECT_NEAR(part(error, "direction").coefficient, kDirection_mm, 5e-4);
  ASSERT_FALSE(error.periods.empty());
  EXPECT_NEAR(error.periods[0].period, kCoggingPeriod_mm, 0.05);
  EXPECT_NEAR(std::hypot(error.periods[0].cosine, error.periods[0].sine), kCogging_mm, 5e-4);
  EXPECT_EQ(host::tracking_json({error})["format"], "axis-tracking/1");
}

TEST(TrackingError, SharesSumToAtMostTheWhole) {
  double sum = 0.0;
  for (const host::TrackingPart& part : host::tracking_error(sample()).parts) {
    EXPECT_GE(part.share, 0.0) << part.with;
    sum += part.share;
  }
  EXPECT_LE(sum, 1.0);
}

TEST(TrackingError, AnExactLoopHasNone) {
  host::Record record = sample();
  record.x = record.x_ref;
  const host::TrackingError error = host::tracking_error(record);
  EXPECT_EQ(error.rms, 0.0);
  for (const host::TrackingPart& part : error.parts) EXPECT_EQ(part.share, 0.0);
}

TEST(TrackingError, SpeedAndItsReferenceServeToo) {
  host::Record record = sample();
  record.w_ref = record.x_ref;
  record.w = record.x;
  record.x.clear(), record.x_ref.clear();
  EXPECT_EQ(host::tracking_error(record).channel, "w_rad_s");
}

TEST(TrackingError, ARecordWithEffortIsForTheModels) {
  host::Record record = sample();
  record.u_V = record.x;
  EXPECT_FALSE(host::has_reference_only(record));
  EXPECT_THROW(host::tracking_error(record), host::Failure);
}

}  // namespace
