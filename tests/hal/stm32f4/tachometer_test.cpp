// Tachometers, scanned once a control period by the timer's trigger and brought to memory by DMA.
#include "hal/cortex_m/registers.hpp"
#include "hal/stm32f4/control_timer.hpp"
#include "hal/stm32f4/tachometer_adc.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using namespace hal::stm32f4;  // NOLINT(google-build-using-namespace): the test is about all of it

class Tachometers : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    chip.adc.is_wired = [](unsigned channel) { return channel == 10 || channel == 11; };
    chip.adc.input_V = [this](unsigned channel) { return channel == 10 ? x_V : channel == 11 ? y_V : 0.0; };
    chip.dma2.knows(samples.data(), samples.size());
    chip.handlers[kDma2Stream0Interrupt] = [this] {
      scan.acknowledge();
      x.conversions_have_arrived();
      y.conversions_have_arrived();
      periods.push_back(chip.bus.now_ns());
      x_reading = x.read();
      y_reading = y.read();
    };
    chip.handlers[kAdcInterrupt] = [this] { scan.recover_from_overrun(); };
  }
  void start(std::uint32_t rate_Hz) {
    scan.start();
    hal::cortex_m::enable_interrupt(kDma2Stream0Interrupt, 1);
    hal::cortex_m::enable_interrupt(kAdcInterrupt, 1);
    timer.start(kTimerClock_Hz, rate_Hz);
  }

  static constexpr std::uint32_t kTimerClock_Hz = 84'000'000;
  double x_V = 1.65, y_V = 1.65;
  TachometerSamples samples{};
  TachometerScan scan{adc1(), adc_common_control(), dma2(), samples};
  ControlTimer timer{timer3()};
  TachometerChannel x{samples, 0}, y{samples, 1};
  hal::TachometerReading x_reading, y_reading;
  std::vector<double> periods;
};

TEST_F(Tachometers, ArriveOncePerPeriod) {
  EXPECT_FALSE(x.read().valid) << "nothing has been converted yet";
  start(1000);
  chip.pass_ms(20.5);
  EXPECT_EQ(periods.size(), 20u);
  for (std::size_t i = 1; i < periods.size(); ++i) EXPECT_NEAR(periods[i] - periods[i - 1], 1e6, 3e3);
  EXPECT_FALSE(x.read().valid) << "a conversion belongs to one period";
}

/// +-10 V arrive as 0 to 3.3 V; four samples are summed.
TEST_F(Tachometers, EachReadsItsOwnInput) {
  x_V = 1.65 + 0.3;
  y_V = 1.65 - 0.7;
  start(1000);
  chip.pass_ms(3.0);
  ASSERT_TRUE(x_reading.valid);
  EXPECT_NEAR(x_reading.code, 4 * 0.3 / 3.3 * 4096, 4.0);
  ASSERT_TRUE(y_reading.valid);
  EXPECT_NEAR(y_reading.code, -4 * 0.7 / 3.3 * 4096, 4.0);
}

TEST_F(Tachometers, AnInputAtARailIsABrokenWire) {
  start(1000);
  for (const double rail : {0.0, 3.3}) {
    x_V = rail;
    chip.pass_ms(3.0);
    EXPECT_FALSE(x_reading.valid);
    EXPECT_TRUE(y_reading.valid);
  }
}

/// Only ADC1's DMA stream starts the control interrupt: an overrun that is not recovered ends control for good.
TEST_F(Tachometers, AnOverrunIsCountedAndTheNextPeriodIsWholeAgain) {
  start(1000);
  chip.pass_ms(5.0);
  ASSERT_EQ(scan.overruns(), 0u);
  chip.dma2.is_stalled = true;
  chip.pass_ms(1.0);
  chip.dma2.is_stalled = false;
  const std::size_t before = periods.size();
  x_V = 2.0;
  y_V = 1.0;
  chip.pass_ms(5.0);
  EXPECT_EQ(scan.overruns(), 1u);
  EXPECT_GE(periods.size(), before + 4);
  EXPECT_NEAR(x_reading.code, 4 * 0.35 / 3.3 * 4096, 4.0) << "each sample is at its place";
  EXPECT_NEAR(y_reading.code, -4 * 0.65 / 3.3 * 4096, 4.0);
}

/// RM0090, 10.3.17: a stream that starts over the flags of its last transfer may not start at all.
TEST_F(Tachometers, StartAnewOverTheFlagsOfAnEarlierTransfer) {
  start(1000);
  chip.handlers.erase(kDma2Stream0Interrupt);
  chip.pass_ms(2.5);
  scan.start();
}

TEST_F(Tachometers, AnOverrunWithinAScanDoesNotExchangeTheAxes) {
  start(20'000);
  x_V = 2.0;
  y_V = 1.0;
  chip.pass_ms(1.0);
  for (int time = 0; time < 8; ++time) {
    chip.bus.pass_ns(50'000 - 3'000 * time);
    chip.dma2.is_stalled = true;
    chip.bus.pass_ns(3'500);
    chip.dma2.is_stalled = false;
    chip.pass_ms(0.5);
    ASSERT_NEAR(x_reading.code, 4 * 0.35 / 3.3 * 4096, 4.0) << time;
  }
  EXPECT_GT(scan.overruns(), 0u);
}

TEST_F(Tachometers, ANewRateCountsFromTheNextPeriodAndAddsNone) {
  start(250);
  chip.pass_ms(2.0);  // the counter is far beyond the new end
  timer.set_rate(20'000);
  periods.clear();
  chip.pass_ms(1.02);
  EXPECT_EQ(periods.size(), 19u) << "the first ends after a whole period and its scan";
  timer.set_rate(1000);
  chip.pass_ms(0.5);
  periods.clear();
  chip.pass_ms(10.0);
  EXPECT_EQ(periods.size(), 10u);
}

}  // namespace
