// If a motion cannot show an effect, this must be reported before the model is called complete.
#include "host/diagnose/visibility.hpp"

#include <gtest/gtest.h>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

double seen(const std::vector<host::Visibility>& effects, const std::string& kind) {
  for (const host::Visibility& effect : effects)
    if (effect.kind == kind) return effect.floors;
  return -1.0;
}

std::vector<host::Visibility> visibility_in(const host::Record& record) {
  const host::RecordSet set = host::compare_on({&record}, HandMade::model());
  return host::visibility_of_effects(HandMade::model(), set, set);
}

/// `length_s` of the hand-made motion, from `from_s` on.
host::Record part_of(const host::Record& whole, double from_s, double length_s) {
  host::Record part = whole;
  const auto begin = static_cast<std::ptrdiff_t>(from_s / HandMade::kPeriod_s);
  const auto end = begin + static_cast<std::ptrdiff_t>(length_s / HandMade::kPeriod_s);
  for (auto* channel : {&part.t_s, &part.u_V, &part.x, &part.w})
    *channel = std::vector<double>(channel->begin() + begin, channel->begin() + end);
  return part;
}

TEST(Visibility, AWholeCycleShowsADelayAndACurvedFriction) {
  const auto effects = visibility_in(HandMade::record(10.0));
  EXPECT_GT(seen(effects, "input_delay"), host::kVisible);
  EXPECT_GT(seen(effects, "nonlinear_viscous"), host::kVisible);
}

TEST(Visibility, AConstantSpeedShowsNeitherDelayNorDifferenceByDirection) {
  // Forward at 50 rad/s for 0.9 s. Nothing changes, so a delay does not show, and there is no backward motion.
  const auto effects = visibility_in(part_of(HandMade::record(5.0), 0.55, 0.9));
  EXPECT_LT(seen(effects, "input_delay"), host::kVisible);
  EXPECT_LT(seen(effects, "viscous_asymmetry"), host::kVisible);
  EXPECT_LT(seen(effects, "constant_torque"), host::kVisible);
}

}  // namespace
