// The drivers on register images in memory: the bits that the reference manual and the data sheets ask for.
#include <gtest/gtest.h>

#include <vector>

#include "hal/ad5752.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/drive_lines.hpp"
#include "hal/stm32f4/encoder_timer.hpp"
#include "hal/stm32f4/parameter_flash.hpp"
#include "hal/stm32f4/spi_port.hpp"
#include "hal/stm32f4/tachometer_adc.hpp"
#include "hal/stm32f4/usart_port.hpp"
#include "hal/stm32f4/usb_controller.hpp"
#include "hal/stm32f4/watchdog.hpp"

namespace {

using hal::stm32f4::DriveLines;
using hal::stm32f4::EncoderTimer;
using hal::stm32f4::FlashInterface;
using hal::stm32f4::Gpio;
using hal::stm32f4::IndependentWatchdog;
using hal::stm32f4::kSystemClock_Hz;
using hal::stm32f4::ParameterFlash;
using hal::stm32f4::Pin;
using hal::stm32f4::Power;
using hal::stm32f4::Rcc;
using hal::stm32f4::Spi;
using hal::stm32f4::SpiPort;
using hal::stm32f4::start_clocks;
using hal::stm32f4::StopInput;
using hal::stm32f4::TachometerChannel;
using hal::stm32f4::TachometerSamples;
using hal::stm32f4::Timer;
using hal::stm32f4::Usart;
using hal::stm32f4::UsartPort;
using hal::stm32f4::Watchdog;

TEST(EncoderTimer, CountsEveryEdgeInBothDirectionsOver32Bits) {
  Timer timer{};
  EncoderTimer encoder(timer);
  encoder.start();
  EXPECT_EQ(timer.SMCR & 7u, 3u) << "encoder mode 3: both edges of both inputs";
  EXPECT_EQ(timer.ARR, 0xFFFFFFFFu);
  EXPECT_EQ(timer.CCMR1 & 0x0303u, 0x0101u) << "channels 1 and 2 are inputs on their own pins";
  EXPECT_EQ(timer.CR1 & 1u, 1u);
  timer.CNT = 0xFFFFFFFEu;  // two counts below zero
  EXPECT_EQ(encoder.read().counts, 0xFFFFFFFEu);
  EXPECT_TRUE(encoder.read().valid);
}

TEST(EncoderTimer, TellsTheIndexOnceAndWhetherOneWasMissed) {
  Timer timer{};
  EncoderTimer encoder(timer);
  EXPECT_FALSE(encoder.read_index().seen);
  timer.SR = 1u << 3;
  timer.CCR3 = 4096;
  EXPECT_EQ(encoder.read_index().counts, 4096u);
  timer.SR = (1u << 3) | (1u << 11);
  EXPECT_TRUE(encoder.read_index().missed);
  EXPECT_EQ(timer.SR & (1u << 11), 0u) << "the overcapture flag is cleared by writing 0";
}

struct Wire {
  std::vector<std::uint32_t> words;
  bool works = true;
  bool send24(std::uint32_t word) {
    words.push_back(word);
    return works;
  }
};

TEST(Ad5752, StartsAtZeroVoltsWithinPlusMinusTen) {
  Wire wire;
  hal::Ad5752 converter(wire);
  EXPECT_TRUE(converter.start());
  // Data sheet, tables 15 to 24: range of both +-10 V; clamp and thermal shutdown; both 0; both powered, in this order.
  EXPECT_EQ(wire.words, (std::vector<std::uint32_t>{0x0C0004, 0x19000C, 0x040000, 0x100005}));
}

TEST(Ad5752, PutsTwosComplementWordsIntoTheChannelsRegister) {
  Wire wire;
  hal::Ad5752 converter(wire);
  EXPECT_TRUE(converter.a().write(1));
  EXPECT_TRUE(converter.b().write(-32767));
  EXPECT_EQ(wire.words, (std::vector<std::uint32_t>{0x000001, 0x028001}));
  wire.works = false;
  EXPECT_FALSE(converter.a().write(0));
}

TEST(SpiPort, GivesUpOnADeadPeripheralAndReleasesTheSelectLine) {
  Spi registers{};
  Gpio port{};
  SpiPort spi(registers, Pin(port, 4));
  EXPECT_FALSE(spi.send24(0x123456));
  EXPECT_EQ(port.BSRR, 1u << 4) << "select high again";
  registers.SR = Spi::kReceived;
  EXPECT_TRUE(spi.send24(0x123456));
  EXPECT_EQ(registers.DR, 0x56u) << "the last byte is the lowest";
}

TEST(Tachometer, SumsItsOwnSamplesOncePerPeriod) {
  TachometerSamples samples{};
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = i % 2 == 0 ? 2148 : 1948;
  TachometerChannel x(samples, 0), y(samples, 1);
  EXPECT_FALSE(x.read().valid) << "nothing has been converted yet";
  x.conversions_have_arrived();
  y.conversions_have_arrived();
  EXPECT_EQ(x.read().code, 400);
  EXPECT_EQ(y.read().code, -400);
  EXPECT_FALSE(x.read().valid) << "a conversion belongs to one period";
}

TEST(Tachometer, AnInputAtARailIsABrokenWire) {
  TachometerSamples samples{};
  for (auto& sample : samples) sample = 2048;
  TachometerChannel x(samples, 0);
  for (const std::uint16_t rail : std::array<std::uint16_t, 2>{0, 4095}) {
    samples[2] = rail;
    x.conversions_have_arrived();
    EXPECT_FALSE(x.read().valid);
  }
}

TEST(ClockTree, ADeadCrystalIsReportedAndNotWaitedForForEver) {
  Rcc rcc{};
  Power power{};
  FlashInterface flash{};
  EXPECT_FALSE(start_clocks(rcc, power, flash));
  EXPECT_EQ(rcc.CFGR, 0u) << "still on the RC oscillator";
}

TEST(ClockTree, RunsAt168MegahertzAnd48ForUsb) {
  Rcc rcc{};
  Power power{};
  FlashInterface flash{};
  rcc.CR = Rcc::kHseReady | Rcc::kPllReady;
  rcc.CFGR = Rcc::kSwitchedToPll;
  static_cast<void>(start_clocks(rcc, power, flash));  // the image does not switch by itself: the flag is overwritten
  const std::uint32_t M = rcc.PLLCFGR & 0x3F, N = rcc.PLLCFGR >> 6 & 0x1FF, P = 2 * ((rcc.PLLCFGR >> 16 & 3) + 1),
                      Q = rcc.PLLCFGR >> 24 & 0xF;
  EXPECT_EQ(8'000'000u / M * N / P, kSystemClock_Hz);
  EXPECT_EQ(8'000'000u / M * N / Q, 48'000'000u);
  EXPECT_EQ(flash.ACR & 7u, 5u) << "wait states at 168 MHz and 3.3 V: table 10";
}

TEST(DriveLines, BrokenWiresReadAsFaultAndStop) {
  Gpio port{};
  DriveLines drive(Pin(port, 4), Pin(port, 6));
  StopInput stop(Pin(port, 10));
  drive.start();
  stop.start();
  EXPECT_EQ(port.BSRR, 1u << (4 + 16)) << "off from its first moment";
  EXPECT_EQ(port.PUPDR >> 12 & 3u, 1u) << "pulled up";
  port.IDR = (1u << 6) | (1u << 10);
  EXPECT_TRUE(drive.is_faulted());
  EXPECT_TRUE(stop.is_pressed());
  port.IDR = 0;
  EXPECT_FALSE(drive.is_faulted());
  EXPECT_FALSE(stop.is_pressed());
  drive.set(true);
  EXPECT_EQ(port.BSRR, 1u << 4);
}

TEST(UsartPort, DividesItsClockToTheBaudRate) {
  Usart registers{};
  UsartPort port(registers);
  port.start(84'000'000, 115'200);
  EXPECT_NEAR(84e6 / registers.BRR, 115'200.0, 0.005 * 115'200.0);
  std::byte byte{};
  EXPECT_FALSE(port.receive(byte));
  registers.SR = Usart::kReceived;
  registers.DR = 0x41;
  EXPECT_TRUE(port.receive(byte));
  EXPECT_EQ(byte, std::byte{0x41});
}

TEST(ParameterFlash, KeepsToTheRulesOfFlash) {
  FlashInterface registers{};
  std::vector<std::byte> memory(2 * 128 * 1024, std::byte{0xFF});
  ParameterFlash flash(registers, memory.data());
  const std::array<std::byte, 4> word{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
  EXPECT_EQ(flash.program(1, 8, word), hal::FlashResult::ok);
  EXPECT_EQ(memory[128 * 1024 + 10], std::byte{3});
  const std::array<std::byte, 4> more{std::byte{0xFF}, std::byte{2}, std::byte{3}, std::byte{4}};
  EXPECT_EQ(flash.program(1, 8, more), hal::FlashResult::not_erased);
  EXPECT_EQ(flash.program(2, 0, word), hal::FlashResult::out_of_range);
  EXPECT_EQ(flash.program(0, 2, word), hal::FlashResult::misaligned);
  EXPECT_EQ(registers.CR, FlashInterface::kLock) << "locked again";
}

TEST(Watchdog, StartsBeforeItIsConfiguredAndStaysWithinItsCounter) {
  IndependentWatchdog registers{};
  Watchdog watchdog(registers);
  watchdog.start(50);
  EXPECT_EQ(registers.RLR, 100u);  // 32 kHz / 16 = 2 ticks a millisecond
  EXPECT_EQ(registers.KR, 0xAAAAu);
  EXPECT_EQ(registers.PR, 2u) << "divider 16, table 107";
  watchdog.start(100'000);
  EXPECT_EQ(registers.RLR, 0xFFFu);
}

/// 32 kHz / 256: an eighth of a tick a millisecond. At 47 kHz, the fastest that the oscillator may run, 4 s are 2.7 s.
TEST(Watchdog, AllowsForTheEraseOfASectorAndThenIsQuickAgain) {
  IndependentWatchdog registers{};
  Watchdog watchdog(registers);
  watchdog.start(50);
  watchdog.allow(4000);
  EXPECT_EQ(registers.PR, 6u) << "divider 256";
  EXPECT_EQ(registers.RLR, 500u);
  EXPECT_EQ(registers.KR, 0xAAAAu) << "fed: the new time-out counts from now";
  watchdog.allow(50);
  EXPECT_EQ(registers.PR, 2u);
  EXPECT_EQ(registers.RLR, 100u);
}

TEST(UsbController, IsClockedAndConnectedWithoutVbus) {
  Rcc rcc{};
  hal::stm32f4::OtgFsGlobal controller{};
  rcc.AHB2ENR = 1u;
  hal::stm32f4::power_usb_controller(rcc, controller);
  EXPECT_EQ(rcc.AHB2ENR, 1u | 1u << 7);
  EXPECT_EQ(controller.GCCFG, 1u << 21);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&controller.GCCFG) - reinterpret_cast<std::uintptr_t>(&controller), 0x38u);
}

TEST(UsbController, MakesTheChipsIdentifierItsSerialNumber) {
  const hal::stm32f4::UniqueIdentifier identifier{{0x89ABCDEF, 0x01234567, 0x00FEDCBA}};
  const auto text = hal::stm32f4::serial_number_text(identifier);
  EXPECT_EQ(std::string(text.begin(), text.end()), "00FEDCBA0123456789ABCDEF");
}

}  // namespace
