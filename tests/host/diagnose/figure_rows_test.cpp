// Finds which of two models predicts held-back records worse.
#include "host/diagnose/figure_rows.hpp"

#include <gtest/gtest.h>

namespace host {
namespace {

ErrorFigures figures(double combined, double x_rms, double w_rms) {
  ErrorFigures error;
  error.combined = combined;
  error.channels = {{"w_rad_s", "rad/s", w_rms, 0.0, {}, 0.1}, {"x_mm", "mm", x_rms, 0.0, {}, 0.001}};
  return error;
}

TEST(WorseModel, HasMoreTimesTheNoiseFloorAndIsFartherOff) {
  EXPECT_TRUE(is_worse(figures(77.5, 0.07, 1.0), figures(22.0, 0.02, 1.1)));
  EXPECT_FALSE(is_worse(figures(22.0, 0.02, 1.1), figures(77.5, 0.07, 1.0)));
  EXPECT_FALSE(is_worse(figures(22.0, 0.02, 1.0), figures(22.0, 0.02, 1.0)));
}

TEST(WorseModel, IsNotMadeBetterByANoiseFloorThatGrewNorWorseByOneThatFell) {
  EXPECT_TRUE(is_worse(figures(10.0, 0.07, 1.2), figures(22.0, 0.02, 1.0)));
  EXPECT_FALSE(is_worse(figures(30.0, 0.01, 0.9), figures(22.0, 0.02, 1.0)));
}

TEST(WorseModel, RunsAway) { EXPECT_TRUE(is_worse(figures(HUGE_VAL, HUGE_VAL, HUGE_VAL), figures(22.0, 0.02, 1.0))); }

}  // namespace
}  // namespace host
