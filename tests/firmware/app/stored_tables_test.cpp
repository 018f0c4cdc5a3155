// Tables of pitch errors in the parameter store: power cut at every operation, damage.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "firmware/app/store/parameter_store.hpp"
#include "hal/pc/simulated_flash.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace {

using firmware::ParameterValues;
using firmware::PitchPoint;
using firmware::SaveResult;
using firmware::StoreState;
using hal::pc::kTornStates;
using hal::pc::PowerCut;
using hal::pc::SimulatedFlash;
using hal::pc::TornState;
using Store = firmware::ParameterStore<SimulatedFlash>;
using Points = std::vector<PitchPoint>;

Points points(int count, int seed) {
  Points list;
  for (int i = 0; i < count; ++i) list.push_back({1000 * i, 100 * i * seed, -70 * i * seed});
  return list;
}

ParameterValues values_of(float k1) {
  ParameterValues values = firmware_test::paper_values();
  firmware_test::set(values, "x.feedback.k1", static_cast<double>(k1));
  return values;
}

SaveResult load(Store& store, const ParameterValues& values, std::uint16_t axis, const Points& table) {
  if (store.begin_table(values.size(), axis, static_cast<std::uint16_t>(table.size()), 0x3F800000) != SaveResult::saved)
    return SaveResult::flash_failed;
  for (const PitchPoint& point : table)
    if (!store.add_point(point)) return SaveResult::flash_failed;
  return store.finish_table(values, firmware::crc32(std::as_bytes(std::span(table))));
}

struct StoredTables {
  firmware::StoreReport report;
  ParameterValues values;
  Points x, y;
};

StoredTables tables_at_start(SimulatedFlash& flash) {
  StoredTables found;
  Store store(flash);
  found.report = store.load(found.values);
  const auto of_axis = [&](std::size_t axis) {
    const auto table = store.table(axis).points;
    return Points(table.begin(), table.end());
  };
  found.x = of_axis(0);
  found.y = of_axis(1);
  return found;
}

/// The state before and after each of: a table, another one, a save, a table in its place.
struct Story {
  ParameterValues first = values_of(1), second = values_of(2);
  Points a = points(5, 1), b = points(7, 2), c = points(3, 3);

  static constexpr int kSteps = 4;
  bool do_step(Store& store, int step) const {
    switch (step) {
      case 0:
        return load(store, first, 0, a) == SaveResult::saved;
      case 1:
        return load(store, first, 1, b) == SaveResult::saved;
      case 2:
        return store.save(second) == SaveResult::saved;
      default:
        return load(store, second, 0, c) == SaveResult::saved;
    }
  }
  bool is_after(const StoredTables& found, int steps) const {
    if (steps == 0) return found.report.state == StoreState::empty && found.x.empty() && found.y.empty();
    return found.report.state == StoreState::loaded && found.values == (steps < 3 ? first : second) &&
           found.x == (steps < 4 ? a : c) && found.y == (steps < 2 ? Points{} : b);
  }
};

TEST(StoredTables, StayThroughSavesAndReplacements) {
  SimulatedFlash flash(2, 4096, 4);
  const Story story;
  for (int step = 0; step < Story::kSteps; ++step) {
    Store store(flash);
    ParameterValues ignored;
    store.load(ignored);
    ASSERT_TRUE(story.do_step(store, step)) << step;
    ASSERT_TRUE(story.is_after(tables_at_start(flash), step + 1)) << step;
  }
}

TEST(StoredTables, APowerCutLeavesWhatWasThereOrWhatIsNew) {
  const Story story;
  SimulatedFlash before(2, 4096, 4);
  std::size_t cuts = 0;
  for (int step = 0; step < Story::kSteps; ++step) {
    SimulatedFlash after = before;
    {
      Store store(after);
      ParameterValues ignored;
      store.load(ignored);
      ASSERT_TRUE(story.do_step(store, step));
    }
    const std::size_t operations = after.operations() - before.operations();
    for (std::size_t operation = 0; operation < operations; ++operation) {
      for (const TornState torn : kTornStates) {
        SimulatedFlash flash = before;
        flash.cut_power_after(operation, torn, static_cast<std::uint32_t>(operation));
        try {
          Store store(flash);
          ParameterValues ignored;
          store.load(ignored);
          story.do_step(store, step);
        } catch (const PowerCut&) {
        }
        flash.restore_power();
        const StoredTables found = tables_at_start(flash);
        ASSERT_TRUE(story.is_after(found, step) || story.is_after(found, step + 1))
            << "step " << step << ", operation " << operation << ", torn " << static_cast<int>(torn);
        // The same operation can be repeated.
        Store store(flash);
        ParameterValues ignored;
        store.load(ignored);
        ASSERT_TRUE(story.do_step(store, step));
        ASSERT_TRUE(story.is_after(tables_at_start(flash), step + 1)) << "step " << step << ", operation " << operation;
        ++cuts;
      }
    }
    before = after;
  }
  std::printf("%zu cut points, no table lost or mixed\n", cuts);
}

/// Every bit of a table and its head.
TEST(StoredTables, DamageIsNamed) {
  SimulatedFlash whole(2, 4096, 4);
  const Story story;
  Store store(whole);
  ParameterValues values;
  store.load(values);
  ASSERT_TRUE(story.do_step(store, 0));
  const std::size_t begin = firmware::kEntriesOffset + values.size() * sizeof(firmware::StoredEntry);
  const std::size_t end = begin + sizeof(firmware::StoredTableHead) + story.a.size() * sizeof(PitchPoint);
  ASSERT_EQ(whole.contents()[0][end], std::byte{0xFF});
  ASSERT_NE(whole.contents()[0][begin], std::byte{0xFF});
  for (std::size_t offset = begin; offset < end; ++offset) {
    for (int bit = 0; bit < 8; ++bit) {
      SimulatedFlash flash = whole;
      flash.contents()[0][offset] ^= static_cast<std::byte>(1 << bit);
      const StoredTables found = tables_at_start(flash);
      ASSERT_EQ(found.report.state, StoreState::damaged) << offset - begin << " bit " << bit;
      ASSERT_TRUE(found.x.empty());
    }
  }
}

TEST(StoredTables, HoldAsManyPointsAsAReaderTakes) {
  SimulatedFlash flash(2, 16384, 4);
  Store store(flash);
  ParameterValues values = values_of(1);
  store.load(values);
  constexpr int kMost = firmware::kMostPitchPoints;
  ASSERT_EQ(load(store, values, 0, points(kMost, 0)), SaveResult::saved);
  EXPECT_EQ(load(store, values, 0, points(kMost + 1, 0)), SaveResult::not_verified);
  EXPECT_EQ(tables_at_start(flash).x, points(kMost, 0)) << "the previous table stays";
}

TEST(StoredTables, NeedRoomAndTheRightPoints) {
  SimulatedFlash flash(2, 2048, 4);
  Store store(flash);
  ParameterValues values = values_of(1);
  store.load(values);
  EXPECT_EQ(load(store, values, 0, points(100, 1)), SaveResult::flash_failed) << "2 kB";
  EXPECT_EQ(flash.operations(), 0u) << "nothing is erased";
  SimulatedFlash larger(2, 4096, 4);
  Store roomy(larger);
  roomy.load(values);
  ASSERT_EQ(roomy.begin_table(values.size(), 0, 2, 0), SaveResult::saved);
  EXPECT_FALSE(roomy.add_point({0, firmware::kLargestDeviation + 1, 0}));
  EXPECT_TRUE(roomy.add_point({0, 0, 0}));
  EXPECT_FALSE(roomy.add_point({0, 0, 0})) << "not beyond the one before";
  EXPECT_TRUE(roomy.add_point({10, 0, 0}));
  EXPECT_FALSE(roomy.add_point({20, 0, 0})) << "one too many";
  EXPECT_EQ(roomy.finish_table(values, 0), SaveResult::not_verified) << "another checksum";
  EXPECT_EQ(tables_at_start(larger).report.state, StoreState::empty);
}

}  // namespace
