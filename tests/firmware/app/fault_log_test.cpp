// The fault log in flash: power cut at every operation, more faults than it keeps, entries without a fault, damage,
// worn cells.
#include "firmware/app/store/fault_log.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "hal/pc/simulated_flash.hpp"

namespace {

using firmware::kLoggedFaults;
using firmware::LoggedFault;
using hal::pc::kTornStates;
using hal::pc::PowerCut;
using hal::pc::SimulatedFlash;
using hal::pc::TornState;
using Log = firmware::FaultLog<SimulatedFlash>;

/// Sectors of 96 entries: after a copy of 64 there is room for some 30 more.
SimulatedFlash blank_flash() { return SimulatedFlash(4, 96 * 32, 4); }

/// The fault as passed to the log, with the log's number.
LoggedFault fault_number(std::uint32_t n) {
  LoggedFault entry;
  entry.number = n;
  entry.run_s = 1000 * n;
  entry.counts_low = 0x89ABCDEF + n;
  entry.counts_high = -static_cast<std::int32_t>(n);
  entry.velocity = 0.25F * static_cast<float>(n);
  entry.dac_code = static_cast<std::int16_t>(-5 * static_cast<int>(n));
  entry.axis = static_cast<std::uint8_t>(n % 4);
  entry.fault = static_cast<std::uint8_t>(1 + n % 34);
  entry.second_fault = static_cast<std::uint8_t>(n % 5);
  entry.activity = static_cast<std::uint8_t>(n % 8);
  return entry;
}

LoggedFault time_alone(std::uint32_t run_s) {
  LoggedFault entry;
  entry.run_s = run_s;
  return entry;
}

template <typename Flash>
firmware::FaultLog<Flash> log_at_start(Flash& flash) {
  firmware::FaultLog<Flash> log(flash);
  log.load();
  return log;
}

/// Expects exactly these entries, beginning with the newest.
template <typename Flash>
void expect_faults_up_to(firmware::FaultLog<Flash>& log, std::uint32_t newest, const std::string& where = "") {
  ASSERT_EQ(log.size(), std::min<std::size_t>(newest, kLoggedFaults)) << where;
  for (std::uint32_t age = 0; age < log.size(); ++age)
    ASSERT_EQ(log.entry(age), fault_number(newest - age)) << where << ", age " << age;
  ASSERT_EQ(log.entry(log.size()), std::nullopt) << where;
}

TEST(FaultLog, IsEmptyOnABlankChip) {
  SimulatedFlash flash = blank_flash();
  Log log = log_at_start(flash);
  expect_faults_up_to(log, 0);
  EXPECT_EQ(log.run_s(), 0u);
}

TEST(FaultLog, KeepsTheNewestOfMany) {
  SimulatedFlash flash = blank_flash();
  for (std::uint32_t n = 0; n < 300;) {
    Log log = log_at_start(flash);
    expect_faults_up_to(log, n, "after a restart");
    for (const std::uint32_t end = n + (n < 70 ? 1 : 37); n < end;) {
      ASSERT_TRUE(log.add(fault_number(++n)));
      expect_faults_up_to(log, n);
    }
  }
}

TEST(FaultLog, LosesNoFaultToTheTimeThatItCounts) {
  SimulatedFlash flash = blank_flash();
  Log log = log_at_start(flash);
  for (std::uint32_t n = 1; n <= 3; ++n) ASSERT_TRUE(log.add(fault_number(n)));
  for (std::uint32_t k = 1; k <= 1000; ++k) ASSERT_TRUE(log.add(time_alone(3000 + 360 * k)));
  Log again = log_at_start(flash);
  expect_faults_up_to(again, 3);
  EXPECT_EQ(again.run_s(), 3000u + 360'000);
  LoggedFault next = fault_number(4);
  next.run_s = 400'000;
  ASSERT_TRUE(again.add(next));
  EXPECT_EQ(again.entry(0)->number, 4u);
}

/// 80 of its 96 places are used, so that the next start-up begins the other sector, and the one after it none.
TEST(FaultLog, KeepsTheTimeInASectorThatAStartUpBegins) {
  SimulatedFlash flash = blank_flash();
  Log log = log_at_start(flash);
  for (std::uint32_t k = 1; k <= 80; ++k) ASSERT_TRUE(log.add(time_alone(360 * k)));
  const std::size_t before = flash.operations();
  EXPECT_EQ(log_at_start(flash).run_s(), 360u * 80);
  const std::size_t begun = flash.operations();
  EXPECT_GT(begun, before);
  EXPECT_EQ(log_at_start(flash).run_s(), 360u * 80);
  EXPECT_EQ(flash.operations(), begun) << "no erase without need";
}

/// The sector that is erased next must be the one without the newest entries, also after a cut.
TEST(FaultLog, LosesNothingToAPowerCutAtAnyOperation) {
  SimulatedFlash before = blank_flash();
  Log full = log_at_start(before);
  constexpr std::uint32_t kBefore = 86, kNew = 14;  // the sector fills up among the new ones
  for (std::uint32_t n = 1; n <= kBefore; ++n) ASSERT_TRUE(full.add(fault_number(n)));
  const auto add_all = [&](Log& log, std::uint32_t& done) {
    for (; done < kBefore + kNew; ++done) ASSERT_TRUE(log.add(fault_number(done + 1)));
  };
  SimulatedFlash rehearsal = before;
  Log rehearsed(rehearsal);
  rehearsed.load();
  std::uint32_t rehearsed_to = kBefore;
  add_all(rehearsed, rehearsed_to);
  const std::size_t operations = rehearsal.operations() - before.operations();
  ASSERT_GT(operations, kNew * 8 + 64 * 8) << "no sector was copied";
  std::size_t cuts = 0;
  for (std::size_t operation = 0; operation < operations; ++operation) {
    for (const TornState torn : kTornStates) {
      const std::string where = std::to_string(operation) + ", torn " + std::to_string(static_cast<int>(torn));
      SimulatedFlash flash = before;
      const auto seed = static_cast<std::uint32_t>(operation);
      std::uint32_t done = kBefore;
      flash.cut_power_after(operation, torn, seed);
      EXPECT_THROW(
          {
            Log log = log_at_start(flash);
            add_all(log, done);
          },
          PowerCut)
          << where;
      flash.cut_power_after(0, torn, seed + 1);
      try {
        log_at_start(flash);
      } catch (const PowerCut&) {  // power failed during a write
      }
      flash.restore_power();
      Log log = log_at_start(flash);
      if (log.entry(0) == fault_number(done + 1)) ++done;  // the interrupted entry was complete
      ASSERT_NO_FATAL_FAILURE(expect_faults_up_to(log, done, where));
      Log again = log_at_start(flash);
      ASSERT_NO_FATAL_FAILURE(expect_faults_up_to(again, done, where + ", second start-up"));
      for (std::uint32_t n = done + 1; n <= done + 40; ++n) ASSERT_TRUE(again.add(fault_number(n))) << where;
      ASSERT_NO_FATAL_FAILURE(expect_faults_up_to(again, done + 40, where + ", 40 later"));
      ++cuts;
    }
  }
  std::printf("%zu operations, %zu cut points, no entry lost or mixed\n", operations, cuts);
}

TEST(FaultLog, ADamagedEntryIsLeftOutAndNoOther) {
  SimulatedFlash flash = blank_flash();
  Log log = log_at_start(flash);
  for (std::uint32_t n = 1; n <= 5; ++n) ASSERT_TRUE(log.add(fault_number(n)));
  const std::size_t sector = flash.contents()[2][0] != std::byte{0xFF} ? 2 : 3;
  flash.contents()[sector][32 * 4 + 9] ^= std::byte{2};  // third entry, after its header and time
  EXPECT_EQ(log.entry(2), std::nullopt) << "it reads back differently";
  Log again = log_at_start(flash);
  ASSERT_EQ(again.size(), 4u);
  EXPECT_EQ(again.entry(1), fault_number(4));
  EXPECT_EQ(again.entry(2), fault_number(2));
}

/// Some cells do not store the data, without reporting an error.
class WornFlash : public SimulatedFlash {
 public:
  using SimulatedFlash::SimulatedFlash;
  hal::FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    const std::size_t place = offset / 32;
    if (place == 20 || place == 21 || place == 50) return hal::FlashResult::ok;
    return SimulatedFlash::program(sector, offset, in);
  }
};

TEST(FaultLog, LeavesPlacesThatDoNotReadBack) {
  WornFlash flash(4, 96 * 32, 4);
  for (std::uint32_t n = 0; n < 200; ++n) {
    auto log = log_at_start(flash);
    expect_faults_up_to(log, n);
    ASSERT_TRUE(log.add(fault_number(n + 1)));
    expect_faults_up_to(log, n + 1);
  }
}

/// A board without these sectors has no log; everything else works.
TEST(FaultLog, IsNothingWithoutItsSectors) {
  SimulatedFlash flash(2, 4096, 4);
  Log log = log_at_start(flash);
  EXPECT_FALSE(log.add(fault_number(1)));
  EXPECT_EQ(log.size(), 0u);
  EXPECT_EQ(flash.operations(), 0u);
}

}  // namespace
