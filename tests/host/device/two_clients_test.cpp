// Two programs at the socket of one simulated board.
#include <gtest/gtest.h>

#include <thread>

#include "firmware/core/supervision/fault_table.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/host/board_at_a_socket.hpp"

namespace {

firmware::ParameterValues values_with_timeout(double timeout_s) {
  firmware::ParameterValues values = firmware_test::paper_values();
  firmware_test::set(values, "host.timeout", timeout_s);
  return values;
}

TEST(TwoPrograms, AMonitorDoesNotKeepTheMotionOfADeadProgramAlive) {
  const BoardAtASocket board;
  host::BoardClient monitor = board.client();
  {
    host::BoardClient mover = board.client();
    mover.write_values(values_with_timeout(0.3));
    host::enable_and_wait(mover, 1);
    mover.jog(0, 5.0);
  }
  host::BoardState status = monitor.status();
  for (int i = 0; i < 2000 && status.axis[0].fault == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    status = monitor.status();
  }
  EXPECT_EQ(status.axis[0].fault, static_cast<std::uint8_t>(firmware::AxisFault::host_heartbeat_lost));
}

TEST(TwoPrograms, TheSecondMovesNothingUnlessItTakesOver) {
  const BoardAtASocket board;
  host::BoardClient first = board.client(), second = board.client();
  first.write_values(values_with_timeout(10.0));
  host::enable_and_wait(first, 1);
  first.jog(0, 2.0);
  try {
    second.jog(0, -2.0);
    ADD_FAILURE() << "the second program moved the first one's axis";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
  }
  second.take_over();
  second.jog(0, -2.0);
  EXPECT_THROW(first.jog(0, 2.0), host::Failure);
  second.stop();
  host::disable_and_wait(first, 1);
}

}  // namespace
