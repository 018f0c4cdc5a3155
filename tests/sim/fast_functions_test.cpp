// The table and the series in the innermost loops against the library's functions, and the short ways through a step
// against the long one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/decay.hpp"
#include "sim/exponential_step.hpp"
#include "sim/harmonic.hpp"
#include "sim/power.hpp"
#include "tests/sim/small_drive.hpp"

namespace {

using sim::Drive;
using sim::DriveState;
using sim_test::with;

TEST(Decay, IsTheExponentialOverItsWholeTable) {
  for (double z = 0.0; z < 37.0; z += 0.000917) ASSERT_NEAR(sim::decay(z) / std::exp(-z), 1.0, 1e-11) << z;
  EXPECT_EQ(sim::decay(0.0), 1.0);
  EXPECT_EQ(sim::decay(1e300), 0.0);
  EXPECT_DOUBLE_EQ(sim::decay(-0.7), std::exp(0.7));
  EXPECT_TRUE(std::isnan(sim::decay(NAN)));
}

TEST(ExponentialFactors, AreTheirDefinitionsOnBothSidesOfTheSeries) {
  for (double z = -3.0; z < 3.0; z += 0.00137) {
    const long double exact1 = std::expm1(static_cast<long double>(z)) / z;
    const auto [phi1, phi2] = sim::exponential_factors(z);
    ASSERT_NEAR(phi1, static_cast<double>(exact1), 1e-10) << z;
    ASSERT_NEAR(phi2, static_cast<double>((exact1 - 1.0L) / z), 1e-10) << z;
  }
}

TEST(CosineOfTurns, IsTheCosineFarFromZeroToo) {
  for (double turns = -3.2; turns < 3.2; turns += 0.000731)
    ASSERT_NEAR(sim::cosine_of_turns(turns), std::cos(2.0 * std::numbers::pi * turns), 1e-13) << turns;
  EXPECT_NEAR(sim::cosine_of_turns(123456.125), std::sqrt(0.5), 1e-13);
}

TEST(Power, IsThePowerInsideAndOutsideItsTable) {
  for (const double exponent : {0.2, 0.5, 1.0, 1.7, 3.0, -0.5}) {
    const sim::Power power(exponent);
    for (double x = 1e-9; x < 1e7; x *= 1.00371) ASSERT_NEAR(power(x) / std::pow(x, exponent), 1.0, 1e-12) << x;
  }
}

TEST(SlideThroughChange, IsAsGoodAsTwoSteps) {
  // A dead time of 0.4 ms against the same drive without, in steps of 0.2 ms, five per command. The error of 1 ms steps
  // when the command changes within them gives the tolerance.
  const Drive late(with(sim_test::stribeck_drive(), "input_delay", {{"delay", 0.0004}}));
  const Drive prompt(sim_test::stribeck_drive());
  const auto command = [](int k) { return 3.0 * std::sin(0.02 * k) + 0.5 * std::sin(0.3 * k); };
  DriveState delayed = late.at(0.0, 0.0), fine = prompt.at(0.0, 0.0), coarse = fine, on_time = fine;
  double travel = 0.0, apart = 0.0, apart_on_time = 0.0;
  for (int k = 0; k < 2000; ++k) {
    late.step(delayed, command(k), 0.001 * k, 0.001);
    prompt.step(coarse, command(k), 0.001 * k, 0.001);
    for (int part = 0; part < 5; ++part) {
      prompt.step(fine, command(part < 2 ? std::max(k - 1, 0) : k), 0.001 * k + 0.0002 * part, 0.0002);
      prompt.step(on_time, command(k), 0.001 * k + 0.0002 * part, 0.0002);
    }
    travel = std::max(travel, std::abs(fine.x));
    apart = std::max(apart, std::abs(delayed.x - fine.x));
    apart_on_time = std::max(apart_on_time, std::abs(coarse.x - on_time.x));
  }
  EXPECT_GT(travel, 1.0);
  EXPECT_LT(apart, 2.0 * apart_on_time);
  EXPECT_LT(apart, 1e-3 * travel);
}

/// The motion under starts, reversals and rests.
DriveState after_a_second(const sim::DriveDescription& description) {
  const Drive drive(description);
  DriveState state = drive.at(0.0, 0.0);
  for (int k = 0; k < 1000; ++k) drive.step(state, 2.0 * std::sin(0.02 * k), 0.001 * k, 0.001);
  return state;
}

TEST(Step, IsTheSameOnEveryWayThroughIt) {
  const sim::DriveDescription base = sim_test::stribeck_drive();
  const DriveState expected = after_a_second(base);
  // Each has no effect, but selects another step function: a contact with more effects, a stage before or after the
  // mass.
  for (const auto& [kind, parameters] : std::map<std::string, std::map<std::string, double>>{
           {"nonlinear_viscous", {{"coefficient", 0.0}, {"exponent", 1.0}}},
           {"position_dependent_friction", {{"cosine", 0.0}, {"sine", 0.0}, {"period", 1e4}}},
           {"cogging", {{"cosine", 0.0}, {"sine", 0.0}, {"period", 1e4}}},
           {"dac_offset", {{"offset", 0.0}}},
           {"current_saturation", {{"limit", 1e3}}}}) {
    const DriveState state = after_a_second(with(base, kind, parameters));
    EXPECT_NEAR(state.x, expected.x, 1e-10) << kind;
    EXPECT_NEAR(state.w, expected.w, 1e-10) << kind;
  }
}

}  // namespace
