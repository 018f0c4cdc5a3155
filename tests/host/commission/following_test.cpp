// Following errors of hand-made records.
#include "host/commission/following.hpp"

#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

/// At rest for `rest` rows, then moves by 1 mm per row, `behind` mm behind its reference.
host::Record moving(std::size_t rest, const std::vector<double>& behind) {
  host::Record record;
  record.kind = sim::DriveKind::rotary;
  double reference = 0.0;
  for (std::size_t k = 0; k < rest + behind.size(); ++k) {
    if (k > rest) reference += 1.0;
    record.t_s.push_back(0.001 * static_cast<double>(k));
    record.x_ref.push_back(reference);
    record.x.push_back(reference - (k < rest ? 5.0 : behind[k - rest]));
  }
  return record;
}

/// Catches an error that includes the rest before the motion, or ignores the middle of the encoder's step.
TEST(FollowingError, IsOfTheMotionAlone) {
  sim::DataSheet data;
  data.encoder_resolution = 0.002;
  const host::FollowingError error = host::following_error(moving(30, {0.004, 0.001, 0.001, 0.001}), data);
  EXPECT_NEAR(error.largest_um, 3.0, 1e-9);
  EXPECT_NEAR(error.rms_um, std::sqrt(9.0 / 4.0), 1e-9);
}

/// Catches a comparison by row number of records that begin at different times.
TEST(FollowingFloor, ComparesTheSameMotionWhereverItBegins) {
  const host::Record once = moving(10, {0.004, 0.001, 0.002, 0.001}), again = moving(25, {0.004, 0.001, 0.002, 0.001});
  EXPECT_NEAR(host::following_floor_um(once, again), 0.0, 1e-9);
  const host::Record other = moving(25, {0.006, 0.003, 0.004, 0.003});
  EXPECT_NEAR(host::following_floor_um(once, other), 2.0 / std::sqrt(2.0), 1e-9);
}

TEST(FollowingError, NeedsAMotion) {
  EXPECT_THROW(host::following_error(moving(30, {}), sim::DataSheet{}), host::Failure);
}

}  // namespace
