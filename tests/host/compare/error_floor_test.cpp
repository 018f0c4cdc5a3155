// What the best possible model would leave.
#include "host/compare/error_floor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

/// A fit on its way may hold static friction that no drive overcomes, and a second mass that it throws about.
TEST(ErrorFloor, OfAModelThatRunsAwayIsANumber) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = HandMade::model();
  model.effects.push_back({"stribeck", {{"static", 3000.0}, {"omega1", 0.19}, {"omega2", 0.19}}, {}, {}});
  model.effects.push_back(
      {"compliance", {{"resonance", 60.0}, {"damping_ratio", 0.02}, {"load_fraction", 0.5}}, {}, {}});
  const host::PreparedRecord prepared = host::prepare(record, model);
  host::ErrorFloor floor;
  host::renew_floor(floor, sim::Drive(model), model.data, prepared, 1);
  ASSERT_EQ(floor.x.size(), prepared.windows.size());
  for (const double value : floor.x) EXPECT_TRUE(std::isfinite(value) && value > 0.0) << value;
}

}  // namespace
