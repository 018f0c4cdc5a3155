// Digital lines, and their readings with broken wires.
#include "hal/cortex_m/cycle_meter.hpp"
#include "hal/stm32f4/charge_pump.hpp"
#include "hal/stm32f4/drive_lines.hpp"
#include "hal/stm32f4/microsecond_clock.hpp"
#include "hal/stm32f4/pin_modes.hpp"
#include "hal/stm32f4/supply_detector.hpp"
#include "hal/stm32f4/usb_controller.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using namespace hal::stm32f4;  // NOLINT(google-build-using-namespace): the test is about all of it
using parts::Drive;
using parts::Outside;
using Lines = driver_test::OnRunningChip;

TEST_F(Lines, TheEnableIsOffFromItsFirstMomentOn) {
  std::vector<Drive> seen;
  chip.port_c.on_change[4] = [&seen](Drive drive) { seen.push_back(drive); };
  gpio_c().ODR = 1u << 4;  // as an earlier program may have left it
  DriveLines lines({Pin(gpio_c(), 4), Pin(gpio_c(), 6), Pin(gpio_c(), 2), Pin(gpio_a(), 3), Pin(gpio_b(), 5)});
  lines.start();
  EXPECT_EQ(seen, std::vector<Drive>{Drive::low});
  lines.set(true);
  EXPECT_EQ(chip.port_c.drive(4), Drive::high);
  lines.set(false);
  EXPECT_EQ(chip.port_c.drive(4), Drive::low);
}

TEST_F(Lines, AnOpenWireIsADriveFault) {
  DriveLines lines({Pin(gpio_c(), 4), Pin(gpio_c(), 6), Pin(gpio_c(), 2), Pin(gpio_a(), 3), Pin(gpio_b(), 5)});
  lines.start();
  EXPECT_TRUE(lines.is_faulted());
  chip.port_c.put(6, Outside::low);
  EXPECT_FALSE(lines.is_faulted());
}

TEST_F(Lines, AnOpenWireIsAnAmplifierThatIsNotReady) {
  DriveLines lines({Pin(gpio_c(), 4), Pin(gpio_c(), 6), Pin(gpio_c(), 2), Pin(gpio_a(), 3), Pin(gpio_b(), 5)});
  lines.start();
  EXPECT_FALSE(lines.is_ready());
  chip.port_c.put(2, Outside::low);
  EXPECT_TRUE(lines.is_ready());
}

TEST_F(Lines, TheBrakeHoldsFromItsFirstMomentOnUntilItIsReleased) {
  std::vector<Drive> seen;
  chip.port_a.on_change[3] = [&seen](Drive drive) { seen.push_back(drive); };
  gpio_a().ODR = 1u << 3;  // as an earlier program may have left it
  DriveLines lines({Pin(gpio_c(), 4), Pin(gpio_c(), 6), Pin(gpio_c(), 2), Pin(gpio_a(), 3), Pin(gpio_b(), 5)});
  lines.start();
  EXPECT_EQ(seen, std::vector<Drive>{Drive::low});
  lines.release_brake(true);
  EXPECT_EQ(chip.port_a.drive(3), Drive::high);
  lines.release_brake(false);
  EXPECT_EQ(chip.port_a.drive(3), Drive::low);
}

/// The motor is never shorted while the amplifier drives.
TEST_F(Lines, TheDynamicBrakeIsReleasedBeforeTheEnableAndAppliedAfterIt) {
  std::vector<std::pair<char, Drive>> seen;
  chip.port_c.on_change[4] = [&seen](Drive drive) { seen.emplace_back('e', drive); };
  chip.port_b.on_change[5] = [&seen](Drive drive) { seen.emplace_back('d', drive); };
  gpio_b().ODR = 1u << 5;  // as an earlier program may have left it
  DriveLines lines({Pin(gpio_c(), 4), Pin(gpio_c(), 6), Pin(gpio_c(), 2), Pin(gpio_a(), 3), Pin(gpio_b(), 5)});
  lines.start();
  EXPECT_EQ(chip.port_b.drive(5), Drive::low) << "shorted from its first moment on";
  seen.clear();
  lines.set(true);
  lines.set(false);
  using Seen = std::vector<std::pair<char, Drive>>;
  EXPECT_EQ(seen, (Seen{{'d', Drive::high}, {'e', Drive::high}, {'e', Drive::low}, {'d', Drive::low}}));
}

TEST_F(Lines, TheRelayOfThePowerIsOpenFromItsFirstMomentOn) {
  gpio_c().ODR = 1u << 11;  // as an earlier program may have left it
  std::vector<Drive> seen;
  chip.port_c.on_change[11] = [&seen](Drive drive) { seen.push_back(drive); };
  RelayOutput relay(Pin(gpio_c(), 11));
  relay.start();
  relay.close(true);
  relay.close(false);
  EXPECT_EQ(seen, (std::vector<Drive>{Drive::low, Drive::high, Drive::low}));
}

TEST_F(Lines, AnOpenStopCircuitIsAPressedStop) {
  StopInput stop(Pin(gpio_c(), 10));
  stop.start();
  EXPECT_TRUE(stop.is_pressed());
  chip.port_c.put(10, Outside::low);
  EXPECT_FALSE(stop.is_pressed());
}

TEST_F(Lines, EndSwitchesOpenWhenActuatedAndTheHomeSwitchCloses) {
  SwitchInputs switches({.positive_end = {gpio_b(), 12}, .negative_end = {gpio_b(), 13}, .home = {gpio_b(), 14}});
  switches.start();
  EXPECT_TRUE(switches.read().positive_end);
  EXPECT_TRUE(switches.read().negative_end);
  EXPECT_FALSE(switches.read().home);
  chip.port_b.put(12, Outside::low);
  EXPECT_FALSE(switches.read().positive_end);
  EXPECT_TRUE(switches.read().negative_end) << "each has its own pin";
  chip.port_b.put(13, Outside::low);
  chip.port_b.put(14, Outside::low);
  EXPECT_FALSE(switches.read().negative_end);
  EXPECT_TRUE(switches.read().home);
}

TEST_F(Lines, TheChargePumpIsASquareWaveThatStopsWithItsBeat) {
  ChargePump pump(Pin(gpio_c(), 12));
  pump.start();
  int edges = 0;
  chip.port_c.on_change[12] = [&edges](Drive) { ++edges; };
  for (int beat = 0; beat < 10; ++beat) pump.beat();
  EXPECT_EQ(edges, 10);
  chip.pass_ms(1.0);
  EXPECT_EQ(edges, 10);
}

TEST_F(Lines, NoUsbSupplyOnAnOpenWire) {
  VbusInput vbus(Pin(gpio_a(), 8));
  vbus.start();
  EXPECT_FALSE(vbus.is_present(0, 100));
  chip.port_a.put(8, Outside::high);
  EXPECT_FALSE(vbus.is_present(99, 100));
  EXPECT_TRUE(vbus.is_present(100, 100));
  EXPECT_TRUE(vbus.is_present(300, 100));
  chip.port_a.put(8, Outside::low);
  EXPECT_TRUE(vbus.is_present(399, 100));
  EXPECT_FALSE(vbus.is_present(400, 100));
}

TEST_F(Lines, TheSupplyIsLowBelowItsThresholdOnly) {
  SupplyDetector detector(power());
  detector.start();
  EXPECT_FALSE(detector.is_low());
  chip.power.supply_V = 2.95;
  EXPECT_FALSE(detector.is_low());
  chip.power.supply_V = 2.85;
  EXPECT_TRUE(detector.is_low());
  EXPECT_TRUE(chip.power.full_speed()) << "the regulator's scale stays";
}

TEST_F(Lines, MicrosecondsGoOnOverTheTimersEnd) {
  MicrosecondClock clock(timer4());
  clock.start(84'000'000);
  const std::uint32_t began_us = clock.now_us();
  for (int step = 0; step < 100; ++step) {
    chip.pass_ms(4.0);
    clock.now_us();
  }
  EXPECT_NEAR(clock.now_us() - began_us, 400e3, 10.0);
}

TEST_F(Lines, TheCycleMeterTellsAverageAndWorstInProcessorClocks) {
  hal::cortex_m::CycleMeter meter;
  meter.start();
  const auto work_us = [&](double time_us) {
    meter.begin();
    chip.bus.pass_ns(1e3 * time_us);
    meter.end();
  };
  work_us(20.0);
  for (int piece = 0; piece < 3000; ++piece) work_us(5.0);
  EXPECT_NEAR(meter.worst(), 20 * 168, 10.0);
  EXPECT_NEAR(meter.average(), 5 * 168, 10.0);
}

TEST_F(Lines, APinKeepsItsNeighboursSettings) {
  const Pin first(gpio_b(), 2), second(gpio_b(), 5), third(gpio_b(), 10);
  first.make_alternate(9, Pull::down);
  second.make_analogue();
  third.make_alternate(1, Pull::up);
  EXPECT_EQ(chip.port_b.function(2), 9);
  EXPECT_EQ(chip.port_b.drive(2), Drive::pulled_down);
  EXPECT_TRUE(chip.port_b.is_analogue(5));
  EXPECT_EQ(chip.port_b.function(10), 1);
  EXPECT_EQ(chip.port_b.drive(10), Drive::pulled_up);
}

TEST_F(Lines, ModesOfPinsAreKeptUntilABitOfThemChanges) {
  Pin(gpio_b(), 5).make_output(true);
  PinModes modes;
  modes.remember();
  Pin(gpio_b(), 5).set(false);
  chip.port_c.put(6, Outside::low);
  EXPECT_TRUE(modes.are_kept()) << "a level is not a mode";
  for (parts::PortPart* port : {&chip.port_a, &chip.port_b, &chip.port_c})
    for (const std::uint32_t offset : {0x00u, 0x04u, 0x08u, 0x0Cu, 0x20u, 0x24u}) {
      const std::uint32_t kept = port->read(offset);
      port->write(offset, kept ^ 1u << 9);
      EXPECT_FALSE(modes.are_kept()) << offset;
      port->write(offset, kept);
      EXPECT_TRUE(modes.are_kept());
    }
}

TEST_F(Lines, TheUsbControllerIsClockedAndTakesNoVbusPin) {
  chip.clock.write(0x34, 0);
  power_usb_controller(rcc(), otg_fs_global());
  EXPECT_EQ(chip.usb.read(0x38), 1u << 21) << "GCCFG.NOVBUSSENS: the clock was on before";
}

TEST_F(Lines, TheChipsIdentifierIsTheSerialNumber) {
  const UniqueIdentifier identifier{{0x89ABCDEF, 0x01234567, 0x00FEDCBA}};
  const auto text = serial_number_text(identifier);
  EXPECT_EQ(std::string(text.begin(), text.end()), "00FEDCBA0123456789ABCDEF");
}

}  // namespace
