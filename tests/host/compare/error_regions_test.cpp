#include "host/compare/error_regions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "host/evidence/regime.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

using host::Regime;

std::size_t row_at(double t_s) { return static_cast<std::size_t>(t_s / HandMade::kPeriod_s); }

TEST(Regimes, FollowTheMotion) {
  host::Record record = HandMade::record();
  for (std::size_t k = row_at(1.0); k < row_at(1.1); ++k) record.u_V[k] = 10.0;
  const sim::DriveDescription model = HandMade::model();
  const host::PreparedRecord prepared = host::prepare(record, model);
  const std::vector<Regime> regimes = host::regimes_of(prepared, model.data);
  EXPECT_EQ(regimes[row_at(0.25)], Regime::acceleration);
  EXPECT_EQ(regimes[row_at(0.7)], Regime::constant_speed);
  EXPECT_EQ(regimes[row_at(1.05)], Regime::saturated_command);
  EXPECT_EQ(regimes[row_at(1.75)], Regime::braking);
  EXPECT_EQ(regimes[row_at(2.25)], Regime::standstill);
  // 100 rad/s^2 from rest: 0.5 * 160 mm/s^2 * t^2 = 50 um after 25 ms. It is 32 um 20 ms after the reversal and 98 um
  // after 35 ms.
  EXPECT_EQ(regimes[row_at(2.52)], Regime::reversal);
  EXPECT_NE(regimes[row_at(2.535)], Regime::reversal);
  EXPECT_EQ(regimes[row_at(2.75)], Regime::acceleration);
  EXPECT_EQ(regimes[row_at(0.015)], Regime::low_speed) << "a start in the first direction is no reversal";
}

class Regions : public testing::Test {
 protected:
  static std::map<std::string, double> sums(const std::vector<host::ErrorRegion>& regions) {
    std::map<std::string, double> sum;
    for (const host::ErrorRegion& region : regions) sum[region.partition] += region.share;
    return sum;
  }
  static const host::ErrorRegion* find(const std::vector<host::ErrorRegion>& regions, const std::string& name) {
    for (const host::ErrorRegion& region : regions)
      if (region.region == name) return &region;
    return nullptr;
  }
};

TEST_F(Regions, SharesSumToOneInEveryPartition) {
  const host::Record record = HandMade::record();
  const sim::DriveDescription model = HandMade::model();
  const auto regions = host::error_regions(model, host::compare_on({&record}, model));
  const auto sum = sums(regions);
  for (const char* partition : {"regime", "direction", "speed", "position", "time", "rest", "frequency", "event"})
    ASSERT_TRUE(sum.contains(partition)) << partition;
  for (const auto& [partition, share] : sum) EXPECT_NEAR(share, 1.0, 1e-9) << partition;
  EXPECT_EQ(host::error_regions_json(regions).size(), regions.size());
}

TEST_F(Regions, NameTheDirectionWhoseFrictionIsWrong) {
  const host::Record record = HandMade::record();
  sim::DriveDescription wrong = HandMade::model();
  wrong.find("coulomb")->parameters["negative"] = -1.5 * HandMade::kCoulomb;
  const auto regions = host::error_regions(wrong, host::compare_on({&record}, HandMade::model()));
  ASSERT_NE(find(regions, "backward"), nullptr);
  EXPECT_GT(find(regions, "backward")->share, 0.95);
}

TEST_F(Regions, NameTheTimeOfAPassingEvent) {
  host::Record record = HandMade::record();
  for (std::size_t k = row_at(6.0); k < row_at(6.4); ++k) record.u_V[k] += 1.0;  // a command without motion
  const sim::DriveDescription model = HandMade::model();
  const auto regions = host::error_regions(model, host::compare_on({&record}, model));
  const host::ErrorRegion* worst = host::worst_region(regions);
  ASSERT_NE(worst, nullptr);
  EXPECT_EQ(worst->partition, "event");
  EXPECT_THAT(host::where_it_fails(regions), testing::HasSubstr("of hand-made.csv"));
  double from_s = 0.0, to_s = 0.0;
  ASSERT_EQ(std::sscanf(worst->region.c_str(), "t = %lf s to %lf s", &from_s, &to_s), 2);
  EXPECT_NEAR(from_s, 6.0, 0.1) << "one window";
  EXPECT_NEAR(to_s, 6.4, 0.1);
}

// Catches "the model fails in motion (75 % of the squared error in 86 % of the samples)".
TEST(WorstRegion, HasMoreOfTheSquaredErrorThanOfTheSamples) {
  const std::vector<host::ErrorRegion> regions{{"rest", "later", "in motion", 0.75, 0.86, 10.0, 0.88},
                                               {"direction", "forward", "forward", 0.36, 0.22, 15.0, 0.34}};
  EXPECT_EQ(host::where_it_fails(regions),
            "the model fails forward (36 % of the squared error in 22 % of the samples)");
}

TEST_F(Regions, AModelThatFitsStandsOutNowhere) {
  const host::Record record = HandMade::record();
  const sim::DriveDescription model = HandMade::model();
  const auto regions = host::error_regions(model, host::compare_on({&record}, model));
  for (const host::ErrorRegion& region : regions) {
    if (region.partition != "direction") continue;
    EXPECT_LT(region.rms, 2.0) << region.region;
  }
}

}  // namespace
