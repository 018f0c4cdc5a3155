// The simulated board against the contracts of the hardware interface.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hal/pc/simulated_axis.hpp"
#include "hal/pc/simulated_flash.hpp"
#include "hal/pc/simulated_panel.hpp"
#include "hal/pc/simulated_usb.hpp"

namespace {

using hal::FlashResult;
using hal::pc::SimulatedAxis;

sim::DriveDescription frictionless_drive() {
  sim::DriveDescription drive;
  drive.data.amplifier_gain_A_per_V = 2.0;
  drive.data.torque_constant_Nm_per_A = 0.5;
  drive.data.lead = 1.5;
  drive.data.dac_resolution_V = 0.25;
  drive.data.encoder_resolution = 0.001;
  drive.data.tach_noise_variance = 0.0;
  drive.effects.push_back({"inertia", {{"J", 0.01}}, {}, {}});
  return drive;
}

TEST(SimulatedAxis, ACodeMovesTheDriveOnlyWhileItIsEnabled) {
  sim::Plant plant(frictionless_drive(), 1);
  SimulatedAxis board(plant);
  EXPECT_TRUE(board.dac().write(4));  // 4 * 0.25 V
  plant.advance(0.1);
  EXPECT_EQ(board.encoder().read().counts, 0u) << "off after reset";
  board.drive_enable().set(true);
  plant.advance(0.1);
  // 1 V * 1 Nm/V / 0.01 kg m^2 = 100 rad/s^2; over 0.1 s: 10 rad/s and 0.75 mm.
  const auto tachometer = board.tachometer().read();
  EXPECT_TRUE(tachometer.valid);
  EXPECT_EQ(tachometer.code, 640);
  EXPECT_NEAR(static_cast<double>(board.encoder().read().counts), 750.0, 1.0);
  EXPECT_TRUE(board.encoder().read().valid);
}

TEST(SimulatedAxis, CountsRunModulo2To32BelowZero) {
  sim::Plant plant(frictionless_drive(), 1);
  SimulatedAxis board(plant);
  board.drive_enable().set(true);
  board.dac().write(-4);
  plant.advance(0.1);
  EXPECT_NEAR(static_cast<double>(static_cast<std::int32_t>(board.encoder().read().counts)), -750.0, 1.0);
}

TEST(SimulatedAxis, WithoutTachometerReadingsAreInvalid) {
  auto drive = frictionless_drive();
  drive.data.tach_noise_variance.reset();
  sim::Plant plant(drive, 1);
  SimulatedAxis board(plant);
  EXPECT_FALSE(board.tachometer().read().valid);
}

TEST(SimulatedAxis, ATachometerBeyondItsConverterIsInvalid) {
  sim::Plant plant(frictionless_drive(), 1);
  SimulatedAxis board(plant, {.tachometer_resolution = 1e-4});
  board.drive_enable().set(true);
  board.dac().write(4);
  plant.advance(0.1);
  EXPECT_FALSE(board.tachometer().read().valid);
}

TEST(SimulatedAxis, SwitchesActAtTheirPlaces) {
  sim::Plant plant(frictionless_drive(), 1);
  SimulatedAxis board(plant, {.negative_end = -10.0, .positive_end = 0.5, .home = 0.2});
  EXPECT_FALSE(board.limits().read().positive_end);
  EXPECT_FALSE(board.limits().read().home);
  board.drive_enable().set(true);
  board.dac().write(4);
  plant.advance(0.07);  // 0.37 mm
  EXPECT_TRUE(board.limits().read().home);
  EXPECT_FALSE(board.limits().read().positive_end);
  plant.advance(0.03);  // 0.75 mm
  EXPECT_TRUE(board.limits().read().positive_end);
  EXPECT_FALSE(board.limits().read().negative_end);
}

TEST(SimulatedAxis, NeedsResolutions) {
  auto without_dac = frictionless_drive();
  without_dac.data.dac_resolution_V = 0.0;
  sim::Plant first(without_dac, 1);
  EXPECT_THROW(SimulatedAxis{first}, std::invalid_argument);
  auto without_encoder = frictionless_drive();
  without_encoder.data.encoder_resolution = 0.0;
  sim::Plant second(without_encoder, 1);
  EXPECT_THROW(SimulatedAxis{second}, std::invalid_argument);
}

TEST(SimulatedFlash, OnlyAnEraseBringsOnesBack) {
  hal::pc::SimulatedFlash flash(2, 64, 4);
  const std::array<std::byte, 4> word{std::byte{0x12}, std::byte{0x34}, std::byte{0x56}, std::byte{0x78}};
  const std::array<std::byte, 4> fewer{std::byte{0x02}, std::byte{0x34}, std::byte{0x00}, std::byte{0x08}};
  std::array<std::byte, 4> out{};
  EXPECT_EQ(flash.program(0, 8, word), FlashResult::ok);
  EXPECT_EQ(flash.program(0, 8, fewer), FlashResult::ok) << "ones may become zeros";
  EXPECT_EQ(flash.program(0, 8, word), FlashResult::not_erased);
  EXPECT_EQ(flash.read(0, 8, out), FlashResult::ok);
  EXPECT_EQ(out, fewer);
  EXPECT_EQ(flash.erase(0), FlashResult::ok);
  EXPECT_EQ(flash.read(0, 8, out), FlashResult::ok);
  EXPECT_EQ(out[0], std::byte{0xFF});
  EXPECT_EQ(flash.program(0, 8, word), FlashResult::ok);
}

TEST(SimulatedFlash, RefusesWhatIsOutsideOrMisaligned) {
  hal::pc::SimulatedFlash flash(2, 64, 4);
  std::array<std::byte, 8> data{};
  EXPECT_EQ(flash.program(0, 60, data), FlashResult::out_of_range);
  EXPECT_EQ(flash.read(2, 0, data), FlashResult::out_of_range);
  EXPECT_EQ(flash.erase(2), FlashResult::out_of_range);
  EXPECT_EQ(flash.program(0, 2, data), FlashResult::misaligned);
  EXPECT_EQ(flash.program(0, 0, std::span(data).first(3)), FlashResult::misaligned);
}

TEST(SimulatedUsb, QueuesAreBoundedAndNothingIsDropped) {
  hal::pc::SimulatedUsb usb(2);
  hal::HidReport report{};
  EXPECT_FALSE(usb.send(report)) << "not configured yet";
  usb.plug_in();
  for (unsigned char i = 0; i < 2; ++i) {
    report[0] = std::byte{i};
    EXPECT_TRUE(usb.host_send(report));
  }
  EXPECT_FALSE(usb.host_send(report));
  for (unsigned char i = 0; i < 2; ++i) {
    EXPECT_TRUE(usb.receive(report));
    EXPECT_EQ(report[0], std::byte{i});
  }
  EXPECT_FALSE(usb.receive(report));
  EXPECT_TRUE(usb.send(report));
  usb.unplug();
  EXPECT_FALSE(usb.is_configured());
  EXPECT_FALSE(usb.host_receive(report));
}

TEST(SimulatedPanel, TimeWrapsAndTheStopStaysPressed) {
  hal::pc::SimulatedClock clock;
  clock.advance_us(0xFFFFFFFFu);
  clock.advance_us(3);
  EXPECT_EQ(clock.now_us(), 2u);
  hal::pc::SimulatedEmergencyStop stop;
  EXPECT_FALSE(stop.is_pressed());
  stop.press();
  EXPECT_TRUE(stop.is_pressed());
  stop.release();
  EXPECT_FALSE(stop.is_pressed());
}

}  // namespace
