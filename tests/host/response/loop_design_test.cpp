// The search for the highest bandwidth where single frequencies of the response forbid some bandwidths.
#include "host/response/loop_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/identify/paper_drives.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/response/axis_controller.hpp"
#include "host/response/plant_fit.hpp"

namespace {

class HighestBandwidth : public testing::Test {
 protected:
  host::HighestLoop on(const host::FinePlant& drive) const {
    return host::highest_bandwidth({{model_, {}, drive}}, aim_, {});
  }

  /// The drive, but with a response at one frequency that takes the loop with poles at `poles_Hz` through -1.
  host::FinePlant without(double poles_Hz, double at_Hz) const {
    host::DesignOptions options;
    options.bandwidth_Hz = poles_Hz;
    const host::AxisController controller(host::designed_parameters(model_, host::design_axis(model_, options), {}));
    host::FinePlant drive = drive_;
    const auto place = static_cast<std::size_t>(std::ranges::lower_bound(drive.f_Hz, at_Hz) - drive.f_Hz.begin());
    Eigen::Vector2cd& plant = drive.plant[place];
    plant /= -(controller.at(drive.f_Hz[place]) * plant)(0);
    return drive;
  }

  const sim::DriveDescription model_ = *host::paper_drive("x");
  const host::FinePlant drive_ = host::fine_plant(host::plant_of(model_));
  const host::LoopAim aim_{0.5, {}, false, {}};
  const double whole_Hz_ = on(drive_).bandwidth_Hz;
};

/// Catches a loop of a few hertz because friction or cogging disturbed the lowest lines of the response.
TEST_F(HighestBandwidth, LiesBeyondAGapAtTheLowestBandwidths) {
  const host::HighestLoop found = on(without(4.0, 5.0));
  EXPECT_EQ(found.bandwidth_Hz, whole_Hz_);
  EXPECT_EQ(found.stopped_by, std::vector<std::size_t>{0});
}

/// Catches a bandwidth in a narrow range beyond a gap, into which a small change of the drive would shift the loop.
TEST_F(HighestBandwidth, LiesBelowAGapBeforeANarrowRange) {
  const double gap_Hz = 0.8 * whole_Hz_;
  const host::HighestLoop found = on(without(gap_Hz, 1.2 * gap_Hz));
  EXPECT_LT(found.bandwidth_Hz, gap_Hz);
  EXPECT_GT(found.bandwidth_Hz, 0.2 * gap_Hz);
}

}  // namespace
