// The service port at a real character rate.
#include <string_view>

#include "hal/serial_queue.hpp"
#include "hal/stm32f4/usart_port.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::stm32f4::usart1;
using hal::stm32f4::UsartPort;

class Usart : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    line.start(84'000'000, 115'200);
  }
  void send(std::string_view text) {
    for (const char character : text) port.send(static_cast<std::byte>(character));
  }
  void poll_for_ms(double time_ms) {
    for (double left = time_ms; left > 0.0; left -= 0.05) {
      port.poll();
      chip.pass_ms(0.05);
    }
  }

  UsartPort line{usart1()};
  hal::SerialQueue<UsartPort, 64> port{line};
};

TEST_F(Usart, SendsEveryCharacterOnceAndInOrder) {
  send("drives off, 0 V\n");
  poll_for_ms(5.0);
  EXPECT_EQ(chip.serial.sent(), "drives off, 0 V\n");
  EXPECT_TRUE(port.is_empty());
}

TEST_F(Usart, NeitherSendingNorPollingWaitsForTheLine) {
  const double began_ns = chip.bus.now_ns();
  send("a report that the line needs five milliseconds for");
  port.poll();
  EXPECT_LT(chip.bus.now_ns() - began_ns, 10e3);
  poll_for_ms(10.0);
  EXPECT_EQ(chip.serial.sent(), "a report that the line needs five milliseconds for");
}

TEST_F(Usart, WhatFindsNoRoomIsLostAndCounted) {
  send(std::string(64, 'a') + "bcd");
  poll_for_ms(10.0);
  EXPECT_EQ(chip.serial.sent(), std::string(64, 'a'));
  EXPECT_EQ(port.lost(), 3u);
  send("e");
  poll_for_ms(1.0);
  EXPECT_EQ(chip.serial.sent(), std::string(64, 'a') + "e");
}

TEST_F(Usart, ReceivesACharacterOnce) {
  std::byte byte{};
  EXPECT_FALSE(port.receive(byte));
  chip.serial.type('r');
  ASSERT_TRUE(port.receive(byte));
  EXPECT_EQ(byte, static_cast<std::byte>('r'));
  EXPECT_FALSE(port.receive(byte));
  chip.serial.type('u');
  chip.serial.type('v');  // lost: one waits
  ASSERT_TRUE(port.receive(byte));
  EXPECT_EQ(byte, static_cast<std::byte>('u'));
  chip.serial.type('w');
  ASSERT_TRUE(port.receive(byte)) << "an overrun does not end reception";
  EXPECT_EQ(byte, static_cast<std::byte>('w'));
}

/// Start-up without crystal: the same rate from the RC oscillator.
TEST_F(Usart, KeepsItsRateOnTheResetClock) {
  chip.clock.write(0x08, 0);
  chip.pass_ms(0.01);
  line.start(16'000'000, 115'200);
  send("ok");
  poll_for_ms(1.0);
  EXPECT_EQ(chip.serial.sent(), "ok");
}

}  // namespace
