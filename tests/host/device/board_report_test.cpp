// A board's faults and running time, in words and in JSON.
#include "host/device/board_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/core/axis_fault.hpp"

namespace {

using firmware::AxisFault;
using testing::HasSubstr;
using testing::Not;

host::BoardState one_axis(AxisFault fault, AxisFault second) {
  host::BoardState state;
  firmware::AxisStatus axis;
  axis.fault = static_cast<std::uint8_t>(fault);
  axis.second_fault = static_cast<std::uint8_t>(second);
  axis.flags = firmware::kAxisFitted;
  state.axis.push_back(axis);
  return state;
}

TEST(BoardReport, TellsWhatWentWrongFirstAndWhatBesides) {
  const auto state = one_axis(AxisFault::host_heartbeat_lost, AxisFault::following_error);
  EXPECT_EQ(host::fault_text(state.axis[0]), "fault 19 host_heartbeat_lost, then 6 following_error");
  const nlohmann::json json = host::board_json("here", {}, state, {});
  EXPECT_EQ(json["axes"][0]["fault"], "host_heartbeat_lost");
  EXPECT_EQ(json["axes"][0]["second_fault"], "following_error");
  EXPECT_EQ(host::fault_text(one_axis(AxisFault::drive_fault, AxisFault::none).axis[0]), "fault 15 drive_fault");
  EXPECT_EQ(host::fault_text(one_axis(AxisFault::none, AxisFault::none).axis[0]), "");
}

TEST(BoardReport, SaysThatTheBrownOutResetIsOff) {
  auto state = one_axis(AxisFault::none, AxisFault::none);
  EXPECT_THAT(host::board_text("here", {}, state, {}), Not(HasSubstr("brown-out")));
  EXPECT_TRUE(host::board_json("here", {}, state, {})["brown_out_reset"].get<bool>());
  state.flags = firmware::kBoardBrownOutOff;
  EXPECT_THAT(host::board_text("here", {}, state, {}), HasSubstr("BOR_LEV=0"));
  EXPECT_FALSE(host::board_json("here", {}, state, {})["brown_out_reset"].get<bool>());
}

TEST(BoardReport, TellsTheClocksOfTheControlInterruptWhereTheyAreCounted) {
  const auto state = one_axis(AxisFault::none, AxisFault::none);
  firmware::TimingPayload timing;
  EXPECT_THAT(host::board_text("here", {}, state, timing), Not(HasSubstr("clocks")));
  timing.cycles_average = 1500;
  timing.cycles_worst = 2100;
  timing.processor_Hz = 168'000'000;
  EXPECT_THAT(host::board_text("here", {}, state, timing),
              HasSubstr("1500 clocks of the processor on average, 2100 at worst, at 168 MHz"));
  const nlohmann::json json = host::board_json("here", {}, state, timing);
  EXPECT_EQ(json["control_cycles"]["worst"], 2100);
}

}  // namespace
