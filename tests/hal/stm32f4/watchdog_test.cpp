// Both watchdogs, which end the run if they are not fed as required.
#include "hal/stm32f4/watchdog.hpp"

#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::stm32f4::independent_watchdog;
using hal::stm32f4::window_watchdog;
using parts::ChipReset;

using IndependentWatchdog = driver_test::OnRunningChip;

TEST_F(IndependentWatchdog, BitesAfterItsTimeAndNotBefore) {
  hal::stm32f4::Watchdog watchdog(independent_watchdog());
  watchdog.start(50);
  chip.pass_ms(49.0);
  watchdog.feed();
  chip.pass_ms(49.0);
  EXPECT_THROW(chip.pass_ms(2.0), ChipReset);
}

/// Datasheet, table 35: the oscillator runs at 17 to 47 kHz. No caller may take longer than the fastest oscillator
/// allows.
TEST_F(IndependentWatchdog, BitesBetween34And95MillisecondsOverTheOscillatorsTolerance) {
  hal::stm32f4::Watchdog watchdog(independent_watchdog());
  chip.independent_watchdog.oscillator_Hz = 47e3;
  watchdog.start(50);
  EXPECT_NEAR(chip.independent_watchdog.timeout_ns(), 34e6, 0.5e6);
  chip.independent_watchdog.oscillator_Hz = 17e3;
  EXPECT_NEAR(chip.independent_watchdog.timeout_ns(), 95e6, 1.0e6);
}

TEST_F(IndependentWatchdog, AllowsForTheEraseOfASectorAndThenIsQuickAgain) {
  hal::stm32f4::Watchdog watchdog(independent_watchdog());
  chip.independent_watchdog.oscillator_Hz = 47e3;
  watchdog.start(50);
  watchdog.allow(4000);
  chip.pass_ms(2600.0);
  watchdog.allow(50);
  chip.pass_ms(30.0);
  EXPECT_THROW(chip.pass_ms(10.0), ChipReset);
}

TEST_F(IndependentWatchdog, AsksForNoMoreThanItsCounterHolds) {
  hal::stm32f4::Watchdog watchdog(independent_watchdog());
  watchdog.start(1'000'000);
  chip.pass_ms(100.0);
  EXPECT_NEAR(chip.independent_watchdog.timeout_ns(), 32.76e9, 0.01e9);
}

class WindowWatchdog : public driver_test::OnRunningChip {
 protected:
  void run_at(std::uint32_t period_us, double time_ms) {
    for (double left = time_ms; left > 0.0; left -= 1e-3 * period_us) {
      chip.bus.pass_ns(1e3 * period_us);
      watchdog.period_passed(period_us);
    }
  }
  hal::stm32f4::PeriodWatchdog watchdog{window_watchdog()};
};

TEST_F(WindowWatchdog, LetsEveryControlRateLive) {
  watchdog.start();
  for (const std::uint32_t period_us : {4000u, 50u, 1000u, 333u, 4000u, 500u}) run_at(period_us, 130.0);
  EXPECT_TRUE(chip.window_watchdog.is_running());
}

TEST_F(WindowWatchdog, EndsAProgramWhoseControlInterruptNeverStarts) {
  watchdog.start();
  EXPECT_THROW(chip.pass_ms(31.0), ChipReset);
}

TEST_F(WindowWatchdog, EndsAProgramWhoseControlInterruptStops) {
  watchdog.start();
  run_at(1000, 100.0);
  EXPECT_THROW(chip.pass_ms(31.0), ChipReset);
}

TEST_F(WindowWatchdog, EndsAProgramWhoseControlInterruptComesTwiceAsOften) {
  watchdog.start();
  run_at(1000, 100.0);
  const auto run_wildly = [this] {
    for (int period = 0; period < 100; ++period) {
      chip.bus.pass_ns(0.5e6);
      watchdog.period_passed(1000);
    }
  };
  EXPECT_THROW(run_wildly(), ChipReset);
}

TEST_F(WindowWatchdog, EndsAProgramWhoseControlInterruptComesHalfAsOften) {
  watchdog.start();
  run_at(1000, 100.0);
  const auto run_slowly = [this] {
    for (int period = 0; period < 100; ++period) {
      chip.bus.pass_ns(2e6);
      watchdog.period_passed(1000);
    }
  };
  EXPECT_THROW(run_slowly(), ChipReset);
}

/// Extends the time-out as the board does for the erase of a sector.
TEST_F(WindowWatchdog, StandsStillWithoutItsClock) {
  watchdog.start();
  run_at(1000, 100.0);
  auto& enables = hal::stm32f4::rcc().APB1ENR;
  enables = enables & ~hal::stm32f4::Rcc::kWindowWatchdog;
  chip.pass_ms(500.0);
  enables = enables | hal::stm32f4::Rcc::kWindowWatchdog;
  run_at(1000, 100.0);
  EXPECT_TRUE(chip.window_watchdog.is_running());
}

/// Catches a first feeding that is too early because periods before the start were counted.
TEST_F(WindowWatchdog, BeginsItsTimeWhenItStarts) {
  hal::stm32f4::rcc().APB1ENR = hal::stm32f4::rcc().APB1ENR & ~hal::stm32f4::Rcc::kWindowWatchdog;
  run_at(1000, 14.0);
  hal::stm32f4::rcc().APB1ENR = hal::stm32f4::rcc().APB1ENR | hal::stm32f4::Rcc::kWindowWatchdog;
  run_at(1000, 9.0);
  watchdog.start();
  run_at(1000, 100.0);
  EXPECT_TRUE(chip.window_watchdog.is_running());
}

}  // namespace
