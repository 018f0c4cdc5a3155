// Error of a model on a set of records.
#include "host/compare/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ranges>
#include <vector>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

double log_loss_of(const sim::Drive& drive, host::RecordSet set, double factor) {
  for (host::ComparedRecord& compared : set.records)
    for (std::vector<double>* floor : {&compared.floor.x, &compared.floor.w})
      for (double& value : *floor) value *= factor;
  return host::error_of(drive, set).log_loss;
}

/// A model that is uncertain of a motion must not be better for it. Where floors are too small, their common factor
/// makes up for it.
TEST(LogLoss, ChargesUncertaintyAndForgivesFloorsThatAreAllTooSmall) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = HandMade::model();
  const host::RecordSet set = host::compare_on({&record}, model);
  for (double& value : model.find("inertia")->parameters | std::views::values) value *= 1.3;
  const sim::Drive wrong(model);
  const double here = log_loss_of(wrong, set, 0.5);
  EXPECT_NEAR(log_loss_of(wrong, set, 0.25), here, 1e-3);
  EXPECT_GT(log_loss_of(wrong, set, 1e3), here + 1.0);
  EXPECT_NEAR(log_loss_of(wrong, set, 1e6) - log_loss_of(wrong, set, 1e5), std::log(10.0), 1e-3);
  EXPECT_LT(log_loss_of(sim::Drive(HandMade::model()), set, 0.5), here);
}

}  // namespace
