#include "host/fit/prepared_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

using host::RecordSet;

class KeptBackBlocks : public testing::Test {
 protected:
  void split(const std::vector<double>& durations_s, double window_s = host::kWindow_s) {
    for (const double duration_s : durations_s) records.push_back(HandMade::record(duration_s));
    std::vector<const host::Record*> pointers;
    for (const host::Record& record : records) pointers.push_back(&record);
    training = host::compare_on(pointers, HandMade::model(), window_s);
    all = training.used_windows();
    kept = host::hold_back(training, validation);
  }
  /// Rows between the nearest windows of the two sets.
  std::size_t nearest() const {
    std::size_t smallest = SIZE_MAX;
    for (const auto& trains : training.records)
      for (const auto& judges : validation.records) {
        if (trains.prepared.record != judges.prepared.record) continue;
        for (const host::Window& a : trains.prepared.windows)
          for (const host::Window& b : judges.prepared.windows) {
            const std::size_t gap = a.begin < b.begin ? b.begin - a.begin - a.length : a.begin - b.begin - b.length;
            smallest = std::min(smallest, gap);
          }
      }
    return smallest;
  }
  std::vector<host::Record> records;
  RecordSet training, validation;
  host::KeptBack kept;
  std::size_t all = 0;
};

TEST_F(KeptBackBlocks, JudgeASingleShortRecordToo) {
  split({5.0});
  EXPECT_GE(validation.used_windows(), all / 4);
  EXPECT_GE(training.used_windows(), all / 4);
}

TEST_F(KeptBackBlocks, OfALongRecordAreTwoSecondsLong) {
  split({60.0});
  EXPECT_NEAR(kept.block_s, 2.0, 0.1);
  EXPECT_EQ(kept.every, 4u);
}

TEST_F(KeptBackBlocks, DoNotTouchWhatTrains) {
  for (const double window_s : {0.1, 0.01}) {
    records.clear();
    split({12.0}, window_s);
    EXPECT_GE(static_cast<double>(nearest()) * HandMade::kPeriod_s, 0.05) << "the smoother's reach";
  }
}

TEST_F(KeptBackBlocks, GoAcrossRecordsThatAreShorterThanARoundOfBlocks) {
  split({0.6, 0.6, 0.6, 0.6, 0.6, 0.6});
  EXPECT_GT(validation.used_windows(), 0u);
  EXPECT_GT(training.used_windows(), 0u);
}

TEST_F(KeptBackBlocks, AreTakenWhereTheAxisMoves) {
  // Half a second of motion, a second of rest. Blocks of equal time might contain only rest.
  host::Record record = HandMade::record(9.0);
  double x = 0.0, w = 0.0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const double t_s = record.t_s[k], phase = std::fmod(t_s, 1.5);
    w = phase < 0.5 ? (static_cast<int>(t_s / 1.5) % 2 == 0 ? 20.0 : -20.0) : 0.0;
    record.x[k] = std::round(x / 0.002) * 0.002;
    record.w[k] = w + 0.1 * std::sin(1.7 * static_cast<double>(k));
    x += HandMade::model().data.lead * w * HandMade::kPeriod_s;
  }
  RecordSet training_set = host::compare_on({&record}, HandMade::model()), kept_back;
  host::hold_back(training_set, kept_back);
  double travel = 0.0;
  for (const host::Window& window : kept_back.records.front().prepared.windows)
    travel += std::abs(record.x[window.begin + window.length] - record.x[window.begin]);
  EXPECT_GT(travel, 20.0);  // mm, of 16 mm in each half second of motion, 96 mm in all
  EXPECT_LT(travel, 60.0);
}

TEST(PreparedSets, SayHowManySecondsAreMissing) {
  const host::Record record = HandMade::record(2.0);
  const host::PreparedSets sets = host::prepare_sets(HandMade::model(), {&record}, {});
  EXPECT_FALSE(sets.moves_enough);
  EXPECT_GT(host::missing_motion_s(sets), 0.1);
  EXPECT_LT(host::missing_motion_s(sets), 3.0);
}

TEST(PreparedSets, OfAFewSecondsOfMotionAreEnough) {
  const host::Record record = HandMade::record(5.0);
  const host::PreparedSets sets = host::prepare_sets(HandMade::model(), {&record}, {});
  EXPECT_TRUE(sets.moves_enough);
  EXPECT_EQ(host::missing_motion_s(sets), 0.0);
  EXPECT_GT(host::error_of(sim::Drive(sets.base), sets.validation).combined, 0.0);
}

}  // namespace
