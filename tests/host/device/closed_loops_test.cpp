// Loops that are closed for a piece of work are opened again, however the work ends.
#include "host/device/closed_loops.hpp"

#include <gtest/gtest.h>

#include "host/device/excitation.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/host/board_at_a_socket.hpp"

namespace {

firmware::ParameterValues both_axes() {
  firmware::ParameterValues values = firmware_test::paper_values();
  firmware_test::fit_axis(values, "y", firmware_test::kPaperX);
  return values;
}

struct DiskFull {};

TEST(ClosedLoops, AnErrorInTheWorkOpensThoseThatWereOpen) {
  const BoardAtASocket board(both_axes());
  host::BoardClient client = board.client();
  host::enable_and_wait(client, 1);
  const auto work = [&] {
    const host::ClosedLoops loops(client, 3);
    EXPECT_TRUE(host::are_enabled(client, 3));
    throw DiskFull();
  };
  EXPECT_THROW(work(), DiskFull);
  EXPECT_EQ(host::enabled_axes(client, 3), 1);
  host::disable_and_wait(client, 3);
}

TEST(ClosedLoops, OpenLeavesNothingToDoAtTheEnd) {
  const BoardAtASocket board(both_axes());
  host::BoardClient client = board.client();
  {
    host::ClosedLoops loops(client, 2);
    loops.open();
    EXPECT_EQ(host::enabled_axes(client, 3), 0);
    host::enable_and_wait(client, 2);
  }
  EXPECT_EQ(host::enabled_axes(client, 3), 2);
  host::disable_and_wait(client, 3);
}

TEST(ClosedLoops, TheAxesOfAnotherProgramAreLeftAlone) {
  const BoardAtASocket board(both_axes());
  host::BoardClient client = board.client(), other = board.client();
  {
    const host::ClosedLoops loops(client, 1);
    other.take_over();
  }
  EXPECT_TRUE(host::are_enabled(other, 1));
  host::disable_and_wait(other, 1);
}

TEST(ClosedLoops, AnErrorDuringAnExcitationOpensTheLoopAndEndsTheCapture) {
  const firmware::ParameterValues values = firmware_test::paper_values();
  const BoardAtASocket board(values);
  host::BoardClient client = board.client();
  const host::ExcitationScale scale = host::excitation_scale(values, 0, sim::DriveKind::rotary);
  const host::Excitation excitation =
      host::design_excitation("ladder", host::parse_numbers({"5"}),
                              host::parse_box("travel=20,speed=20,volts=3,time=3", sim::DriveKind::rotary), scale);
  const auto fail = [](std::size_t rows) {
    if (rows > 10) throw DiskFull();
  };
  EXPECT_ANY_THROW(host::run_excitation(
      client, 0, excitation, values, scale, [] { return false; }, fail));
  EXPECT_EQ(host::enabled_axes(client, 1), 0);
  EXPECT_EQ(client.status().flags & firmware::kBoardCapturing, 0);
}

}  // namespace
