// The parameter store: power cut at every operation, damage, migration.
#include "firmware/app/store/parameter_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "hal/pc/simulated_flash.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace {

using firmware::ParameterValues;
using firmware::SaveResult;
using firmware::StoreState;
using firmware_test::paper_values;
using firmware_test::place_named;
using firmware_test::set;
using hal::pc::kTornStates;
using hal::pc::PowerCut;
using hal::pc::SimulatedFlash;
using hal::pc::TornState;
using Store = firmware::ParameterStore<SimulatedFlash>;

/// The smallest possible sectors, because memory beyond the set is not used.
SimulatedFlash blank_store() { return SimulatedFlash(2, 2048, 4); }

/// A set in which every parameter differs from every other generation's.
ParameterValues generation(int number) {
  ParameterValues values;
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place) {
    const firmware::ParameterRule& rule = firmware::rule_at(place);
    const float toggled = static_cast<float>(number % 2);
    const float whole = rule.minimum + std::fmod(static_cast<float>(number), rule.maximum - rule.minimum + 1);
    const float real = rule.minimum + (rule.maximum - rule.minimum) * 0.01F * static_cast<float>(number);
    values.set(place, rule.type == firmware::ParameterType::toggle  ? toggled
                      : rule.type == firmware::ParameterType::whole ? whole
                                                                    : real);
  }
  return values;
}

struct StoredParameters {
  firmware::StoreReport report;
  ParameterValues values;
};

StoredParameters load_at_start(SimulatedFlash& flash) {
  StoredParameters found;
  Store store(flash);
  found.report = store.load(found.values);
  return found;
}

void save(SimulatedFlash& flash, const ParameterValues& values) {
  Store store(flash);
  ParameterValues ignored;
  store.load(ignored);
  ASSERT_EQ(store.save(values), SaveResult::saved);
}

TEST(ParameterStore, IsEmptyOnABlankChip) {
  SimulatedFlash flash = blank_store();
  const StoredParameters found = load_at_start(flash);
  EXPECT_EQ(found.report.state, StoreState::empty);
  EXPECT_EQ(found.values, ParameterValues{});
}

TEST(ParameterStore, ReturnsTheLastOfManySaves) {
  SimulatedFlash flash = blank_store();
  for (int i = 1; i <= 7; ++i) {
    save(flash, generation(i));
    const StoredParameters found = load_at_start(flash);
    EXPECT_EQ(found.report.state, StoreState::loaded);
    EXPECT_EQ(found.values, generation(i));
    EXPECT_EQ(found.report.sequence, static_cast<std::uint32_t>(i));
    EXPECT_EQ(found.report.erases, static_cast<std::uint32_t>(i)) << "each save erases one sector once";
  }
}

TEST(ParameterStore, SavesTwiceWithoutARestart) {
  SimulatedFlash flash = blank_store();
  Store store(flash);
  ASSERT_EQ(store.save(generation(1)), SaveResult::saved);
  ASSERT_EQ(store.save(generation(2)), SaveResult::saved);
  EXPECT_EQ(load_at_start(flash).values, generation(2));
}

/// Cuts power at one operation of two consecutive saves. Then starts up, with another cut at the first operation, and
/// saves again.
void cut_once(const SimulatedFlash& before, std::size_t operation, TornState torn, const ParameterValues& old,
              StoreState old_state) {
  const std::string where =
      "operation " + std::to_string(operation) + ", torn state " + std::to_string(static_cast<int>(torn));
  SimulatedFlash flash = before;
  const ParameterValues sets[] = {old, generation(2), generation(3)};
  const auto seed = static_cast<std::uint32_t>(operation);
  std::size_t done = 0;
  flash.cut_power_after(operation, torn, seed);
  EXPECT_THROW(
      {
        for (; done < 2; ++done) save(flash, sets[done + 1]);
      },
      PowerCut);
  flash.cut_power_after(0, torn, seed + 1);
  try {
    load_at_start(flash);
  } catch (const PowerCut&) {  // power failed during a write
  }
  flash.restore_power();
  const StoredParameters found = load_at_start(flash);
  const bool is_old = found.values == sets[done];
  ASSERT_TRUE(is_old || found.values == sets[done + 1]) << where << ": neither the old set nor the new one";
  const bool was_empty = is_old && done == 0 && old_state == StoreState::empty;
  ASSERT_EQ(found.report.state, was_empty ? StoreState::empty : StoreState::loaded) << where;
  ASSERT_EQ(load_at_start(flash).values, found.values) << where << ": the next start-up finds another set";
  save(flash, generation(4));
  ASSERT_EQ(load_at_start(flash).values, generation(4)) << where;
}

std::size_t cut_everywhere(const SimulatedFlash& before, const ParameterValues& old, StoreState old_state) {
  SimulatedFlash rehearsal = before;
  save(rehearsal, generation(2));
  save(rehearsal, generation(3));
  const std::size_t operations = rehearsal.operations() - before.operations();
  std::size_t cuts = 0;
  for (std::size_t operation = 0; operation < operations; ++operation) {
    for (const TornState torn : kTornStates) {
      cut_once(before, operation, torn, old, old_state);
      if (testing::Test::HasFatalFailure()) return cuts;
      ++cuts;
    }
  }
  std::printf("%zu operations in two saves, %zu cut points, none lost or mixed a set\n", operations, cuts);
  testing::Test::RecordProperty("cut_points", static_cast<int>(cuts));
  return cuts;
}

TEST(PowerCut, AtEveryOperationOfTwoSavesLeavesTheOldSetOrTheNew) {
  SimulatedFlash flash = blank_store();
  save(flash, generation(1));
  // Each save: one erase, two words for each entry, six words of header, two marks.
  EXPECT_EQ(cut_everywhere(flash, generation(1), StoreState::loaded),
            4 * 2 * (1 + 2 * firmware::parameter_count(hal::kAxisCount) + 6 + 2));
}

TEST(PowerCut, AtEveryOperationOfTheFirstSaveEverLeavesNothingOrTheNewSet) {
  cut_everywhere(blank_store(), ParameterValues{}, StoreState::empty);
}

/// A power cut during a save, and another during the next save.
TEST(PowerCut, TwiceInARowLeavesOneOfTheSetsThatWereSaved) {
  SimulatedFlash before = blank_store();
  save(before, generation(1));
  const std::size_t per_save = before.operations();
  std::size_t cuts = 0;
  for (std::size_t first = 0; first < per_save; ++first) {
    for (std::size_t second = first % 7; second < per_save; second += 7) {
      SimulatedFlash flash = before;
      for (const auto& [operation, number] : {std::pair{first, 2}, std::pair{second, 3}}) {
        flash.cut_power_after(operation, kTornStates[(first + second) % 4], static_cast<std::uint32_t>(first));
        try {
          save(flash, generation(number));
        } catch (const PowerCut&) {
        }
      }
      flash.restore_power();
      const StoredParameters found = load_at_start(flash);
      ASSERT_EQ(found.report.state, StoreState::loaded) << first << " " << second;
      ASSERT_TRUE(found.values == generation(1) || found.values == generation(2) || found.values == generation(3))
          << first << " " << second;
      ++cuts;
    }
  }
  std::printf("%zu pairs of cuts\n", cuts);
}

TEST(DamagedStore, IsNamedAndNeverReplacedByTheSetBefore) {
  SimulatedFlash whole = blank_store();
  save(whole, generation(1));
  save(whole, generation(2));
  const std::size_t newest = 1;
  const std::size_t used =
      firmware::kEntriesOffset + firmware::parameter_count(hal::kAxisCount) * sizeof(firmware::StoredEntry);
  const std::size_t superseded_mark = firmware::kMarksOffset + offsetof(firmware::StoredMarks, superseded);
  for (std::size_t offset = 0; offset < used; ++offset) {
    if (offset / 4 == superseded_mark / 4) continue;
    for (int bit = 0; bit < 8; ++bit) {
      SimulatedFlash flash = whole;
      flash.contents()[newest][offset] ^= static_cast<std::byte>(1 << bit);
      const StoredParameters found = load_at_start(flash);
      ASSERT_EQ(found.report.state, StoreState::damaged) << "byte " << offset << " bit " << bit;
      ASSERT_EQ(found.values, ParameterValues{});
    }
  }
}

TEST(DamagedStore, HealsByTheNextSave) {
  SimulatedFlash flash = blank_store();
  save(flash, generation(1));
  save(flash, generation(2));
  flash.contents()[1][100] ^= std::byte{1};
  ASSERT_EQ(load_at_start(flash).report.state, StoreState::damaged);
  save(flash, generation(3));
  EXPECT_EQ(load_at_start(flash).report.state, StoreState::loaded);
  EXPECT_EQ(load_at_start(flash).values, generation(3));
}

TEST(DamagedStore, OfTheOlderSetIsNoMatter) {
  SimulatedFlash flash = blank_store();
  save(flash, generation(1));
  save(flash, generation(2));
  flash.contents()[0][100] ^= std::byte{1};
  EXPECT_EQ(load_at_start(flash).report.state, StoreState::loaded);
  EXPECT_EQ(load_at_start(flash).values, generation(2));
}

TEST(DamagedStore, BothSlots) {
  SimulatedFlash flash = blank_store();
  save(flash, generation(1));
  save(flash, generation(2));
  for (auto& sector : flash.contents()) sector[100] ^= std::byte{1};
  EXPECT_EQ(load_at_start(flash).report.state, StoreState::damaged);
  save(flash, generation(3));
  EXPECT_EQ(load_at_start(flash).values, generation(3));
}

/// A chip that does not take one word.
class FlashThatLosesOneWrite : public SimulatedFlash {
 public:
  using SimulatedFlash::SimulatedFlash;
  hal::FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    if (sector == 1 && offset == 200) return hal::FlashResult::ok;  // claims success
    return SimulatedFlash::program(sector, offset, in);
  }
};

TEST(ParameterStore, ReadsBackWhatItWroteBeforeItCounts) {
  FlashThatLosesOneWrite flash(2, 2048, 4);
  firmware::ParameterStore store(flash);
  ASSERT_EQ(store.save(generation(1)), SaveResult::saved);
  ASSERT_EQ(store.save(generation(2)), SaveResult::not_verified);
  ParameterValues values;
  EXPECT_EQ(firmware::ParameterStore(flash).load(values).state, StoreState::loaded);
  EXPECT_EQ(values, generation(1));
}

/// A set as another firmware wrote it: by hand, from the description of the layout.
SimulatedFlash flash_of_another_table(const std::vector<firmware::StoredEntry>& entries) {
  SimulatedFlash flash = blank_store();
  firmware::StoredHeader header{firmware::kStoreMagic, 0x12345678, 9, 0, 17, 0};
  header.length = static_cast<std::uint32_t>(entries.size() * sizeof(firmware::StoredEntry));
  firmware::Crc32 crc;
  crc.add(std::as_bytes(std::span(&header, 1)).first(20)).add(std::as_bytes(std::span(entries)));
  header.crc = crc.value();
  const std::uint32_t mark = firmware::kValidMark;
  flash.program(0, 32, std::as_bytes(std::span(entries)));
  flash.program(0, 0, std::as_bytes(std::span(&header, 1)));
  flash.program(0, 24, std::as_bytes(std::span(&mark, 1)));
  return flash;
}

TEST(Migration, FindsEachValueByItsIdAndGivesNewParametersTheirInitialValue) {
  SimulatedFlash flash =
      flash_of_another_table({{0x1000 | 80, 0, std::bit_cast<std::uint32_t>(33.5F)},    // x.feedback.k1
                              {0x2000 | 64, 0, std::bit_cast<std::uint32_t>(0.25F)}});  // y.kalman.k11
  const StoredParameters found = load_at_start(flash);
  EXPECT_EQ(found.report.state, StoreState::migrated);
  EXPECT_EQ(found.report.schema_hash, 0x12345678u);
  EXPECT_EQ(found.report.erases, 17u);
  ParameterValues expected;
  set(expected, "x.feedback.k1", 33.5);
  set(expected, "y.kalman.k11", 0.25);
  EXPECT_EQ(found.values, expected);
}

TEST(Migration, ReportsWhatFitsNoMoreAndKeepsItReadable) {
  const std::vector<firmware::StoredEntry> entries = {
      {0x1000 | 80, 0, std::bit_cast<std::uint32_t>(33.5F)},
      {0x1000 | 4000, 0, std::bit_cast<std::uint32_t>(1.0F)},               // no such parameter
      {0x1000 | 64, 0, std::bit_cast<std::uint32_t>(5.2F)},                 // x.kalman.k11, above its maximum
      {0x1000 | 65, 0, std::bit_cast<std::uint32_t>(1e38F) | 0x7F800000}};  // not a number
  SimulatedFlash flash = flash_of_another_table(entries);
  Store store(flash);
  ParameterValues values;
  const firmware::StoreReport report = store.load(values);
  EXPECT_EQ(report.state, StoreState::incomplete);
  EXPECT_EQ(report.not_migrated, 3);
  EXPECT_EQ(values.at(place_named("x.feedback.k1")), 33.5F);
  EXPECT_EQ(values.at(place_named("x.kalman.k11")), 0.0F);
  ASSERT_EQ(store.entry_count(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(store.entry(i)->key, entries[i].key);
    EXPECT_EQ(store.entry(i)->value_bits, entries[i].value_bits);
  }
  EXPECT_EQ(store.entry(entries.size()), std::nullopt);
}

}  // namespace
