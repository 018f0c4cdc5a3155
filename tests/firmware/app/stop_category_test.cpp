// The edges of an emergency stop: ramp, enable, power.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::MessageType;
using firmware::Status;
using firmware::SupervisorState;
using Bench = firmware_test::BoardOnABench<>;

/// Control periods from the opening of the circuit to each action of the stop.
struct StopEdges {
  int ramp_begins = 0, enable_off = 0, power_off = 0;
  double way_mm = 0.0;
};
StopEdges edges_of_stop(double delay_s, double speed_mm_s, int pressed_periods = 2000) {
  Bench bench;
  bench.fit_and_enable_x(5.0);
  EXPECT_EQ(bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(100);
  firmware::ParameterValues values = bench.application.active();
  firmware_test::set(values, "emergency_stop.delay", delay_s);
  EXPECT_EQ(bench.download(values).status, Status::ok);
  bench.run(200);
  EXPECT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
  bench.run(5);
  EXPECT_TRUE(bench.board.power_relay().is_closed());
  EXPECT_EQ(bench.ask(MessageType::jog, firmware::JogRequest{0, {}, static_cast<float>(speed_mm_s)}).status,
            Status::ok);
  bench.run(600);
  const double before_mm = bench.board.plant(0).truth().x;
  bench.board.emergency_stop().press();
  StopEdges edges;
  for (int k = 1; k <= 2000; ++k) {
    if (k == pressed_periods) bench.board.emergency_stop().release();
    bench.run(1);
    if (edges.ramp_begins == 0 && bench.application.axes()[0].state() != SupervisorState::enabled)
      edges.ramp_begins = k;
    if (edges.enable_off == 0 && !bench.board.axis(0).drive_enable().is_on()) edges.enable_off = k;
    if (edges.power_off == 0 && !bench.board.power_relay().is_closed()) edges.power_off = k;
  }
  edges.way_mm = std::abs(bench.board.plant(0).truth().x - before_mm);
  EXPECT_EQ(bench.status().axis[0].fault, static_cast<std::uint8_t>(firmware::AxisFault::emergency_stop));
  EXPECT_EQ(bench.status().axis[0].state, static_cast<std::uint8_t>(SupervisorState::fault));
  bench.board.emergency_stop().release();
  bench.run(2);
  EXPECT_TRUE(bench.board.power_relay().is_closed()) << "the circuit is closed";
  EXPECT_EQ(bench.ask(MessageType::clear_faults).status, Status::ok);
  bench.run(200);
  EXPECT_EQ(bench.status().axis[0].fault, 0) << "once is enough";
  return edges;
}

TEST(StopCategory, AStopOfCategory0DropsEnableAndPowerTogether) {
  const StopEdges edges = edges_of_stop(0.0, 100.0);
  EXPECT_EQ(edges.enable_off, 3) << "2 ms of filter";
  EXPECT_EQ(edges.power_off, 3);
}

/// The timing diagram of front-end.md.
TEST(StopCategory, AStopOfCategory1RampsThenDropsTheEnableThenThePower) {
  const StopEdges edges = edges_of_stop(0.5, 100.0);
  EXPECT_LE(edges.ramp_begins, 4);
  EXPECT_GE(edges.enable_off, 50) << "100 mm/s at 2000 mm/s^2";
  EXPECT_LE(edges.enable_off, 200);
  EXPECT_EQ(edges.power_off, edges.enable_off) << "all axes stand: nothing to wait for";
  EXPECT_LT(edges.way_mm, 100.0 * 100.0 / 4000.0 + 100.0 * 0.02 + 1.0);
}

TEST(StopCategory, AStopOfCategory1WaitsNoLongerThanItsDelay) {
  const StopEdges edges = edges_of_stop(0.03, 200.0);
  EXPECT_LE(edges.ramp_begins, 4);
  EXPECT_EQ(edges.enable_off, 33);
  EXPECT_EQ(edges.power_off, 33);
}

TEST(StopCategory, AShortPressIsAStopToo) {
  const StopEdges edges = edges_of_stop(0.5, 100.0, 10);
  EXPECT_LE(edges.ramp_begins, 4);
  EXPECT_EQ(edges.power_off, edges.enable_off);
}

}  // namespace
