// Periods at which the fit of a wave starts. Records in closed form (made_effort.hpp).
#include <gtest/gtest.h>

#include "host/compare/comparison.hpp"
#include "host/search/candidate_starts.hpp"
#include "sim/catalogue.hpp"
#include "tests/host/effort/made_effort.hpp"

namespace {

constexpr double kPeriod = 1.25;  // mm

double small_wave(const Point& point) { return 0.003 * std::cos(kTurn * point.x / kPeriod); }

/// Up to 60 rad/s.
Point fast_turning(double t_s) {
  const double fast = kTurn * 0.2;
  return {-60.0 / fast * std::cos(fast * t_s), 60.0 * std::sin(fast * t_s), 60.0 * fast * std::cos(fast * t_s)};
}

TEST(WaveStarts, AFineWaveOfSlowMotionIsNotCoveredByTheNoiseOfFastMotion) {
  sim::DriveDescription model = motor();
  model.find("inertia")->parameters["J"] = kInertia;
  model.find("viscous")->parameters["B"] = kViscous;
  model.find("coulomb")->parameters["level"] = kCoulomb;
  const host::Record slow = record_of(slow_turning, small_wave, 0.0, 20.0, 1);
  const auto with_noise = [](const Point& point) {
    const double noise = std::abs(point.w) > 20.0 ? 0.5 * std::sin(37.0 * point.x * point.x) : 0.0;
    return small_wave(point) + noise;
  };
  const host::Record fast = record_of(fast_turning, with_noise, 0.0, 20.0, 2);
  const std::vector<sim::DriveDescription> starts =
      host::starting_models(*sim::find_effect("cogging"), model, host::compare_on({&slow, &fast}, model));
  ASSERT_FALSE(starts.empty());
  EXPECT_NEAR(starts.front().effects.back().at("period"), kPeriod, 0.01);
}

}  // namespace
