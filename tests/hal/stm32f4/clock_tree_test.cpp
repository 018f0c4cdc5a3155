// The clock tree from every state that start-up may find.
#include "hal/stm32f4/clock_tree.hpp"

#include "hal/stm32f4/option_bytes.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using namespace hal::stm32f4;  // NOLINT(google-build-using-namespace): the test is about all of it
using ClockTree = driver_test::OnChip;

bool start() { return reset_clocks(rcc()) && start_clocks(rcc(), power(), flash_interface()); }

TEST_F(ClockTree, RunsAt168MegahertzAnd48ForUsb) {
  ASSERT_TRUE(start());
  EXPECT_EQ(chip.clock.system_Hz(), 168e6);
  EXPECT_EQ(chip.clock.usb_Hz(), 48e6);
  EXPECT_EQ(chip.clock.apb1_Hz(), double{kApb1Clock_Hz});
  EXPECT_EQ(chip.clock.apb2_Hz(), double{kApb2Clock_Hz});
  EXPECT_EQ(chip.clock.apb1_timers_Hz(), double{kApb1TimerClock_Hz});
  EXPECT_TRUE(chip.clock.watches_crystal());
}

TEST_F(ClockTree, ComesToTheSameAfterABootRomThatLeftThePllRunning) {
  chip.clock.leave_as_boot_rom();
  ASSERT_NE(chip.clock.system_Hz(), 16e6);
  ASSERT_TRUE(start());
  EXPECT_EQ(chip.clock.system_Hz(), 168e6);
  EXPECT_EQ(chip.clock.usb_Hz(), 48e6);
}

TEST_F(ClockTree, ComesToTheSameFromItsOwnStateToo) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(start());
  EXPECT_EQ(chip.clock.system_Hz(), 168e6);
}

/// A loader's USB controller or timer must not continue to run.
TEST_F(ClockTree, ResetsWhatAnEarlierProgramLeftOn) {
  chip.clock.leave_as_boot_rom();
  chip.usb.write(0x38, 1u << 16);  // GCCFG.PWRDWN: its transceiver
  chip.port_a.write(0x00, 0xFFFFFFFF);
  ASSERT_TRUE(start());
  EXPECT_EQ(chip.usb.read(0x38), 0u);
  EXPECT_EQ(chip.port_a.read(0x00), 0xA8000000u) << "the debug port's pins stay the debugger's";
}

TEST_F(ClockTree, ADeadCrystalIsReportedAndNotWaitedForForEver) {
  chip.clock.crystal_works = false;
  EXPECT_FALSE(start());
  EXPECT_EQ(chip.clock.system_Hz(), double{kResetClock_Hz});
  EXPECT_LT(chip.bus.now_ns(), 1e9);
}

TEST_F(ClockTree, ACrystalThatDiedUnderTheBootRomIsReported) {
  chip.clock.leave_as_boot_rom();
  chip.clock.crystal_works = false;
  EXPECT_FALSE(start());
  EXPECT_EQ(chip.clock.system_Hz(), double{kResetClock_Hz});
}

/// RM0090, 3.9.6: BOR_LEV 3 is off, 0 the highest threshold.
TEST_F(ClockTree, TellsTheBrownOutThresholdOfTheOptionBytes) {
  EXPECT_EQ(brown_out_threshold(flash_interface()), 0u) << "as delivered";
  chip.flash.option_bytes &= ~0xCu;
  EXPECT_EQ(brown_out_threshold(flash_interface()), 270u);
  chip.flash.option_bytes |= 1u << 2;
  EXPECT_EQ(brown_out_threshold(flash_interface()), 240u);
}

}  // namespace
