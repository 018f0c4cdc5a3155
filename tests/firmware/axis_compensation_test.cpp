// Compensation in the control law: no effect when switched off; a move across a gap ends at its target.
#include <gtest/gtest.h>

#include <vector>

#include "firmware/core/axis.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "tests/firmware/friction_drive.hpp"

namespace {

using firmware::AxisParameters;
using firmware::CountPosition;
using firmware::kOneCount;
using firmware_test::kPaperX;

struct ClosedLoop {
  explicit ClosedLoop(const AxisParameters<float>& parameters)
      : plant(firmware_test::friction_drive(kPaperX), 1), board(plant), axis(board) {
    EXPECT_EQ(axis.configure(parameters), firmware::Refusal::none);
    axis.step();
    axis.set_home(0);
    EXPECT_TRUE(axis.enable());
  }

  void move_to(std::int64_t counts) {
    EXPECT_TRUE(axis.start(axis.plan_move_to(CountPosition::at(counts)).plan));
    do {
      step();
    } while (!axis.is_at_rest());
  }
  void step() {
    words.push_back(axis.step().dac_code);
    plant.advance(firmware_test::kSamplePeriod_s);
  }

  sim::Plant plant;
  hal::pc::SimulatedAxis board;
  firmware::Axis<float, hal::pc::SimulatedAxis> axis;
  std::vector<std::int32_t> words;
};

AxisParameters<float> with_friction() {
  auto parameters = firmware_test::parameters_of<float>(kPaperX);
  parameters.friction_feedforward_on = parameters.zero_phase_feedforward_on = true;
  return parameters;
}

AxisParameters<float> compensating() {
  auto parameters = with_friction();
  auto& c = parameters.compensation;
  c.cogging_on = c.position_friction_on = true;
  c.cogging_V[0] = {0.1f, 0.1f, kOneCount / 1024};
  c.position_friction = {0.2f, 0.1f, kOneCount / 20'000};
  c.presliding = {true, 20.0f, 0.3f};
  c.backlash = {true, 16 * kOneCount, 5 * kOneCount, 10};
  return parameters;
}

std::vector<std::int32_t> words_of(const AxisParameters<float>& parameters) {
  ClosedLoop loop(parameters);
  loop.move_to(4096);
  loop.move_to(0);
  return loop.words;
}

TEST(Compensation, SwitchedOffItsValuesDoNotMatter) {
  auto off = compensating();
  auto& c = off.compensation;
  c.cogging_on = c.position_friction_on = c.presliding.on = c.backlash.on = false;
  const auto plain = words_of(with_friction());
  EXPECT_EQ(words_of(off), plain);
  EXPECT_NE(words_of(compensating()), plain);
}

TEST(Compensation, SwitchedOffItsValuesNeedNoSense) {
  auto off = with_friction();
  off.compensation.cogging_V[0] = {0.1f, 0.1f, 0};
  off.compensation.position_friction = {0.1f, 0.1f, -kOneCount};
  off.compensation.presliding = {false, 0.0f, -1.0f};
  off.compensation.backlash = {false, -kOneCount, -kOneCount, 0};
  EXPECT_EQ(words_of(off), words_of(with_friction()));
}

TEST(Compensation, FrictionsPartsNeedFrictionFeedforward) {
  auto parameters = with_friction();
  parameters.friction_feedforward_on = false;
  const auto plain = words_of(parameters);
  parameters.compensation.presliding = compensating().compensation.presliding;
  parameters.compensation.position_friction_on = true;
  parameters.compensation.position_friction = compensating().compensation.position_friction;
  EXPECT_EQ(words_of(parameters), plain);
}

TEST(Compensation, AMoveEndsWithTheTableAtItsTargetAndTheMotorBeyondTheGap) {
  auto parameters = with_friction();
  parameters.compensation.backlash = compensating().compensation.backlash;
  constexpr std::int64_t kShift = 16 / 2 + 5;  // half the gap and the wind-up, counts
  ClosedLoop loop(parameters);
  std::int64_t last = 0;
  for (const std::int64_t target : {4096, 8192, 1000, -500, 0}) {
    loop.move_to(target);
    EXPECT_EQ(loop.axis.table_reference(), CountPosition::at(target));
    EXPECT_EQ(loop.axis.telemetry().reference, CountPosition::at(target + (target > last ? kShift : -kShift)));
    last = target;
  }
  loop.axis.disable();
  loop.step();
  EXPECT_EQ(loop.axis.telemetry().fault, firmware::AxisFault::none);
}

}  // namespace
