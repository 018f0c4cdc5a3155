// A board that finds home, and functions that need home.
#include <gtest/gtest.h>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::AxisFault;
using firmware::MessageType;
using firmware::ParameterValues;
using firmware::Status;
using firmware_test::set;

constexpr std::uint8_t kHomedBits = firmware::kAxisHomed;

template <typename Scalar>
struct HomingBench {
  /// x fitted with `mode`, enabled, not homed.
  void start(int mode, double velocity = 20.0) {
    ParameterValues values = firmware_test::paper_values();
    set(values, "x.homing.mode", mode);
    set(values, "x.homing.velocity", velocity);
    set(values, "x.homing.creep_velocity", 2.0);
    set(values, "x.homing.index_travel", 3.5);
    set(values, "x.homing.travel", 30.0);
    set(values, "x.homing.position", 100.0);
    start(values);
  }
  void start(const ParameterValues& values) {
    ASSERT_EQ(bench.download(values).status, Status::ok);
    bench.run(200);
    ASSERT_EQ(bench.ask(MessageType::enable, firmware::AxesRequest{1}).status, Status::ok);
    bench.run(5);
  }
  Status home(bool here) {
    return bench.ask(MessageType::home, firmware::HomeRequest{0, static_cast<std::uint8_t>(here ? 1 : 0)}).status;
  }
  /// Runs while the host sends requests.
  void run(int periods) {
    for (int k = 0; k < periods; k += 50) {
      bench.run(50);
      bench.ask(MessageType::heartbeat);
    }
  }
  firmware::AxisStatus axis() { return bench.status().axis[0]; }
  bool is_homed() { return (axis().flags & kHomedBits) != 0; }
  /// Position on the board minus position of the drive, mm.
  double offset_mm() {
    return static_cast<double>(axis().counts()) * firmware_test::kEncoderResolution_mm - bench.board.plant(0).truth().x;
  }
  AxisFault fault() { return bench.application.axes()[0].fault(); }

  firmware_test::BoardOnABench<Scalar> bench;
};

template <typename Scalar>
class HomingOfABoard : public testing::Test, public HomingBench<Scalar> {};
using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(HomingOfABoard, Scalars);

/// Home is at `place` of the drive, and has the position 100 mm.
struct FoundCase {
  int mode;
  double velocity, place;
};

TYPED_TEST(HomingOfABoard, CountsFromThePlaceThatItFinds) {
  for (const FoundCase& wanted : {FoundCase{1, 20.0, 5.0}, {2, 20.0, 1.0}, {3, 20.0, 7.0}, {2, -20.0, -2.0}}) {
    SCOPED_TRACE(testing::Message() << "mode " << wanted.mode << ", " << wanted.velocity << " mm/s");
    HomingBench<TypeParam> board;
    board.start(wanted.mode, wanted.velocity);
    EXPECT_FALSE(board.is_homed());
    ASSERT_EQ(board.home(false), Status::ok);
    board.run(100);
    EXPECT_NE(board.axis().flags & firmware::kAxisHoming, 0);
    EXPECT_EQ(board.bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 1.0F}).status, Status::wrong_state);
    board.run(6000);
    EXPECT_EQ(board.fault(), AxisFault::none);
    EXPECT_EQ(board.axis().flags & firmware::kAxisHoming, 0);
    ASSERT_TRUE(board.is_homed());
    EXPECT_NEAR(board.offset_mm(), 100.0 - wanted.place, 0.01) << "an edge is seen a period of creep late, or less";
    ASSERT_EQ(board.bench.ask(MessageType::move, firmware::MoveRequest::to(0, 98 * 4096 / 10)).status, Status::ok);
    board.run(2000);
    EXPECT_NEAR(board.offset_mm(), 100.0 - wanted.place, 0.01);
  }
}

TYPED_TEST(HomingOfABoard, UnhomedAxesMoveByAWayButNotToAPlace) {
  this->start(0);
  EXPECT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::to(0, 100)).status, Status::not_homed);
  ASSERT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::by(0, 1000)).status, Status::ok);
  this->run(1000);
  EXPECT_NEAR(static_cast<double>(this->axis().counts()), 1000.0, 2.0);
  EXPECT_EQ(this->home(false), Status::homing_mode) << "this mode has no search";
  ASSERT_EQ(this->home(true), Status::ok);
  EXPECT_TRUE(this->is_homed());
  EXPECT_NEAR(static_cast<double>(this->axis().counts()) * firmware_test::kEncoderResolution_mm, 100.0, 0.01);
  this->run(200);
  EXPECT_EQ(this->fault(), AxisFault::none) << "a new origin of the counts causes no fault";
  const auto here = this->axis().counts();
  ASSERT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::to(0, here - 500)).status, Status::ok);
  this->run(1000);
  EXPECT_NEAR(static_cast<double>(this->axis().counts()), static_cast<double>(here - 500), 2.0);
}

TYPED_TEST(HomingOfABoard, AnUnhomedAxisMovesByNoMoreThanItsWholeTravel) {
  ParameterValues values = firmware_test::paper_values();
  set(values, "x.monitor.travel_min", -10.0);
  set(values, "x.monitor.travel_max", 20.0);
  this->start(values);
  const auto by = [this](double way_mm) {
    const auto counts = static_cast<std::int64_t>(way_mm / firmware_test::kEncoderResolution_mm);
    return this->bench.ask(MessageType::move, firmware::MoveRequest::by(0, counts)).status;
  };
  EXPECT_EQ(by(30.1), Status::outside_travel);
  EXPECT_EQ(by(-30.1), Status::outside_travel);
  EXPECT_EQ(by(5.0), Status::ok);
}

TYPED_TEST(HomingOfABoard, AnAxisThatCanFindHomeIsNotTold) {
  this->start(1);
  EXPECT_EQ(this->home(true), Status::homing_mode);
  EXPECT_FALSE(this->is_homed());
}

TYPED_TEST(HomingOfABoard, ASwitchThatIsNeverFoundStopsTheAxis) {
  this->start(1, -20.0);  // away from the switch
  ASSERT_EQ(this->home(false), Status::ok);
  this->run(4000);
  EXPECT_EQ(this->fault(), AxisFault::homing_switch_not_found);
  EXPECT_FALSE(this->is_homed());
  EXPECT_FALSE(this->bench.board.axis(0).drive_enable().is_on());
  EXPECT_GT(this->bench.board.plant(0).truth().x, -31.0) << "it stops after 30 mm and a ramp";
}

TYPED_TEST(HomingOfABoard, ASilentHostEndsIt) {
  this->start(1, -20.0);
  ASSERT_EQ(this->home(false), Status::ok);
  this->bench.run(1000);
  EXPECT_EQ(this->fault(), AxisFault::host_heartbeat_lost);
  EXPECT_FALSE(this->is_homed());
}

TYPED_TEST(HomingOfABoard, AStopEndsItUnhomed) {
  this->start(1);
  ASSERT_EQ(this->home(false), Status::ok);
  this->run(100);
  ASSERT_EQ(this->bench.ask(MessageType::stop).status, Status::ok);
  this->run(3000);
  EXPECT_EQ(this->axis().flags & (firmware::kAxisHoming | firmware::kAxisHomed), 0);
  EXPECT_EQ(this->fault(), AxisFault::none);
}

TYPED_TEST(HomingOfABoard, NothingKnowsItsPlaceAfterAResetOrWithOtherCounts) {
  this->start(0);
  ASSERT_EQ(this->home(true), Status::ok);
  ASSERT_EQ(this->bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  this->run(300);
  EXPECT_TRUE(this->is_homed()) << "the encoder counts on";
  ParameterValues values = this->bench.application.active();
  set(values, "x.feedback.k1", 47);
  ASSERT_EQ(this->bench.download(values).status, Status::ok);
  EXPECT_TRUE(this->is_homed());
  set(values, "x.homing.position", 7);
  ASSERT_EQ(this->bench.download(values).status, Status::ok);
  EXPECT_FALSE(this->is_homed());
  ASSERT_EQ(this->bench.ask(MessageType::save).status, Status::ok);
  firmware_test::BoardOnABench<TypeParam> again(&this->bench.board.parameter_flash());
  EXPECT_EQ(again.status().axis[0].flags & kHomedBits, 0);
}

TYPED_TEST(HomingOfABoard, TravelLimitsAndCoggingWaitForIt) {
  ParameterValues values = firmware_test::paper_values();
  set(values, "x.monitor.travel_max", 3.0);
  set(values, "x.monitor.travel_min", -3.0);
  set(values, "x.cogging.on", 1);
  set(values, "x.cogging.cosine_1", 0.02);
  this->start(values);
  const auto cogging = [this] { return this->bench.application.axes()[0].telemetry().friction_V; };
  EXPECT_EQ(cogging(), TypeParam(0)) << "standing, friction adds nothing";
  EXPECT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::by(0, 4096)).status, Status::outside_travel)
      << "10 mm are more than the whole travel";
  ASSERT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::by(0, 2048)).status, Status::ok);
  this->run(2000);
  EXPECT_EQ(this->fault(), AxisFault::none) << "5 mm from where it was";
  ASSERT_EQ(this->home(true), Status::ok);
  this->run(100);
  EXPECT_NE(cogging(), TypeParam(0));
  EXPECT_EQ(this->fault(), AxisFault::none);
  EXPECT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::by(0, 4096)).status, Status::outside_travel);
  EXPECT_EQ(this->bench.ask(MessageType::move, firmware::MoveRequest::to(0, 4096)).status, Status::outside_travel);
  ASSERT_EQ(this->bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 10.0F}).status, Status::ok);
  this->run(1000);
  EXPECT_EQ(this->fault(), AxisFault::none);
  EXPECT_NEAR(static_cast<double>(this->axis().counts()) * firmware_test::kEncoderResolution_mm, 2.8, 0.2)
      << "the jog ends inside";
}

/// The limits are 2 mm apart, the switch is 5 mm away.
TYPED_TEST(HomingOfABoard, ASearchIsLimitedByItsOwnTravelAndAnAbandonedOneByThatOfTheAxis) {
  this->start(1);
  ParameterValues values = this->bench.application.active();
  ASSERT_EQ(this->bench.ask(MessageType::disable, firmware::AxesRequest{1}).status, Status::ok);
  this->run(300);
  set(values, "x.monitor.travel_max", 1.0);
  set(values, "x.monitor.travel_min", -1.0);
  set(values, "x.homing.position", 0.0);
  this->start(values);
  ASSERT_EQ(this->home(false), Status::ok);
  this->run(200);
  ASSERT_EQ(this->bench.ask(MessageType::stop).status, Status::ok);
  this->run(500);
  const double from_mm = this->bench.board.plant(0).truth().x;
  EXPECT_GT(from_mm, 2.0);
  ASSERT_EQ(this->bench.ask(MessageType::jog, firmware::JogRequest{0, {}, 5.0F}).status, Status::ok);
  this->run(2000);
  EXPECT_NEAR(this->bench.board.plant(0).truth().x - from_mm, 1.7, 0.4) << "2 mm from the stop";
  ASSERT_EQ(this->bench.ask(MessageType::jog, firmware::JogRequest{0, {}, -5.0F}).status, Status::ok);
  this->run(500);
  ASSERT_EQ(this->bench.ask(MessageType::stop).status, Status::ok);
  this->run(500);
  ASSERT_EQ(this->home(false), Status::ok);
  this->run(6000);
  EXPECT_EQ(this->fault(), AxisFault::none);
  EXPECT_TRUE(this->is_homed());
}

TEST(HomeIsLost, WhereTheEncoderMayHaveMissedCounts) {
  for (const auto fault :
       {AxisFault::encoder_invalid, AxisFault::encoder_jump, AxisFault::encoder_tachometer_disagreement})
    EXPECT_TRUE(firmware::loses_position(fault));
  EXPECT_FALSE(firmware::loses_position(AxisFault::host_heartbeat_lost));
}

}  // namespace
