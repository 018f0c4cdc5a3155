// The catalogue as a whole: complete, consistent, and without effect at zero strength.
#include "sim/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::catalogue;
using sim::Drive;
using sim::DriveState;
using sim::EffectInfo;
using sim::ParameterInfo;
using sim_test::coulomb_drive;
using sim_test::kCoulomb;
using sim_test::with;

/// The names that model files and other programs use.
const std::set<std::string_view> kKinds = {
    "inertia",
    "viscous",
    "coulomb",
    "stribeck",
    "coulomb_asymmetry",
    "viscous_asymmetry",
    "nonlinear_viscous",
    "presliding",
    "friction_lag",
    "dwell_stiction",
    "position_dependent_friction",
    "thermal_friction_drift",
    "constant_torque",
    "cogging",
    "torque_ripple",
    "compliance",
    "backlash",
    "input_delay",
    "current_loop_lag",
    "current_saturation",
    "dac_dead_zone",
    "dac_offset",
    "tach_gain",
    "tach_offset",
    "tach_lag",
    "tach_ripple",
    "encoder_cyclic_error",
    "pitch_error",
    "thermal_growth",
    "load_dependent_friction",
    "spring_torque",
    "voltage_limit",
    "external_torque",
    "free_curve",
};

TEST(Catalogue, HoldsExactlyTheKnownKinds) {
  std::multiset<std::string_view> kinds;
  for (const EffectInfo* info : catalogue()) kinds.insert(info->kind);
  EXPECT_EQ(kinds, (std::multiset<std::string_view>(kKinds.begin(), kKinds.end())));
}

TEST(Catalogue, FindsByKind) {
  for (const EffectInfo* info : catalogue()) EXPECT_EQ(sim::find_effect(info->kind), info);
  EXPECT_EQ(sim::find_effect("gremlins"), nullptr);
}

TEST(Catalogue, TheBaseIsInertiaViscousCoulomb) {
  std::set<std::string_view> base;
  for (const EffectInfo* info : catalogue())
    if (info->base) base.insert(info->kind);
  EXPECT_EQ(base, (std::set<std::string_view>{"inertia", "viscous", "coulomb"}));
}

class EveryEffect : public testing::TestWithParam<const EffectInfo*> {};

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::ValuesIn(catalogue().begin(), catalogue().end()),
                         [](const auto& instance) { return std::string(instance.param->kind); });

TEST_P(EveryEffect, HasAllItsTexts) {
  const EffectInfo& info = *GetParam();
  for (const std::string_view text :
       {info.title, info.equation, info.shows, info.separate_by, info.origin, info.remedy})
    EXPECT_GE(text.size(), 5u);
  EXPECT_FALSE(info.confused_with.empty());
  EXPECT_FALSE(info.parameters.empty());
  EXPECT_NE(info.install, nullptr);
}

TEST_P(EveryEffect, SaysWhatItsTraceGoesWith) {
  const std::set<std::string_view> coordinates = {"speed",        "position", "travel_since_reversal",
                                                  "acceleration", "current",  "rest",
                                                  "temperature",  "time",     "frequency"};
  const EffectInfo& info = *GetParam();
  EXPECT_EQ(info.along.empty(), info.curve);  // a free curve depends on the requested coordinate
  for (const std::string_view coordinate : info.along) EXPECT_TRUE(coordinates.contains(coordinate)) << coordinate;
}

TEST_P(EveryEffect, IsConfusedWithOthersThatExist) {
  const EffectInfo& info = *GetParam();
  std::set<std::string_view> seen;
  for (const std::string_view other : info.confused_with) {
    EXPECT_NE(sim::find_effect(other), nullptr) << other;
    EXPECT_NE(other, info.kind);
    EXPECT_TRUE(seen.insert(other).second) << other << " is listed twice";
  }
}

TEST_P(EveryEffect, HasParametersWithNamesBoundsAndStarts) {
  const EffectInfo& info = *GetParam();
  std::set<std::string_view> ids, rotary, linear;
  for (const ParameterInfo& parameter : info.parameters) {
    EXPECT_TRUE(ids.insert(parameter.id).second) << parameter.id;
    EXPECT_TRUE(rotary.insert(parameter.rotary_key).second) << parameter.rotary_key;
    EXPECT_TRUE(linear.insert(parameter.linear_key).second) << parameter.linear_key;
    EXPECT_FALSE(parameter.doc.empty()) << parameter.id;
    EXPECT_LT(parameter.lower, parameter.upper) << parameter.id;
    EXPECT_EQ(info.parameter(parameter.id), &parameter);
    if (parameter.scale == sim::Scale::unity)
      for (const double start : parameter.starts) {
        EXPECT_GE(start, parameter.lower) << parameter.id;
        EXPECT_LE(start, parameter.upper) << parameter.id;
      }
    const bool period_is_searched = info.periodic && parameter.id == "period";
    EXPECT_TRUE(!parameter.starts.empty() || period_is_searched) << parameter.id << ": a fit needs a start";
    EXPECT_TRUE(parameter.pair_of.empty() || parameter.optional) << parameter.id;
  }
  EXPECT_EQ(info.parameter("gremlins"), nullptr);
}

TEST_P(EveryEffect, HasKeysThatEndInAUnitOrAreRatios) {
  using testing::EndsWith;
  const std::set<std::string_view> ratios = {"asymmetry",     "exponent",      "gain",           "coefficient",
                                             "damping_ratio", "load_fraction", "load_friction",  "load_viscous",
                                             "cosine",        "sine",          "viscous_change", "coulomb_change"};
  const auto rotary_unit =
      testing::AnyOf(EndsWith("_Nm"), EndsWith("_kg_m2"), EndsWith("_Nm_s_per_rad"), EndsWith("_rad_s"),
                     EndsWith("_mm"), EndsWith("_Nm_per_rad"), EndsWith("_Nm_per_mm"), EndsWith("_A"), EndsWith("_V"),
                     EndsWith("_s"), EndsWith("_Hz"), EndsWith("_um_per_m"));
  const auto linear_unit =
      testing::AnyOf(EndsWith("_N"), EndsWith("_kg"), EndsWith("_N_s_per_m"), EndsWith("_m_s"), EndsWith("_m"),
                     EndsWith("_um_per_m"), EndsWith("_N_per_m"), EndsWith("_V"), EndsWith("_s"), EndsWith("_Hz"));
  for (const ParameterInfo& parameter : GetParam()->parameters) {
    const std::string rotary(parameter.rotary_key), linear(parameter.linear_key);
    if (GetParam()->curve && parameter.id == "knot") continue;  // its unit is that of the entry's coordinate
    if (ratios.contains(parameter.id) && rotary == parameter.id) {
      EXPECT_EQ(linear, parameter.id);
      continue;
    }
    EXPECT_THAT(rotary, rotary_unit);
    EXPECT_THAT(linear, linear_unit);
    EXPECT_THAT(linear, testing::Not(testing::HasSubstr("rad")));
  }
}

TEST_P(EveryEffect, PeriodicOnesHaveTwoAmplitudesAndAPeriod) {
  const EffectInfo& info = *GetParam();
  const bool has_harmonic = info.parameter("cosine") && info.parameter("sine") && info.parameter("period");
  EXPECT_EQ(info.periodic, has_harmonic);
}

TEST_P(EveryEffect, SaysWhichPairOneValueStandsFor) {
  for (const ParameterInfo& parameter : GetParam()->parameters) {
    if (parameter.pair_of.empty()) continue;
    const std::size_t blank = parameter.pair_of.find(' ');
    ASSERT_NE(blank, std::string_view::npos);
    const ParameterInfo* forward = GetParam()->parameter(parameter.pair_of.substr(0, blank));
    const ParameterInfo* backward = GetParam()->parameter(parameter.pair_of.substr(blank + 1));
    ASSERT_TRUE(forward && backward);
    EXPECT_EQ(forward->lower, -backward->upper) << "backward values are negative";
    EXPECT_EQ(forward->upper, -backward->lower);
  }
}

/// Parameters with which an effect has no strength, and how far a motion may differ from the drive without it.
struct Powerless {
  std::map<std::string, double> parameters;
  double tolerance = 0.0;  ///< of the largest travel and speed
};

const std::map<std::string_view, Powerless> kPowerless = {
    {"stribeck", {{{"static", kCoulomb}, {"omega1", 2.0}, {"omega2", 2.0}}, 1e-12}},
    {"coulomb_asymmetry", {{{"asymmetry", 0.0}}}},
    {"viscous_asymmetry", {{{"asymmetry", 0.0}}}},
    {"nonlinear_viscous", {{{"coefficient", 0.0}, {"exponent", 0.5}}}},
    // Breaks away after nanometres; a difference of some milliseconds remains at each reversal.
    {"presliding", {{{"sigma0", 1e6}, {"sigma1", 20.0}}, 1e-3}},
    {"friction_lag", {{{"time", 1e-9}}, 1e-12}},
    {"dwell_stiction", {{{"gain", 0.0}, {"time_constant", 1.0}}}},
    {"position_dependent_friction", {{{"cosine", 0.0}, {"sine", 0.0}, {"period", 10.0}}, 1e-12}},
    {"thermal_friction_drift", {{{"viscous_change", 0.0}, {"coulomb_change", 0.0}, {"time_constant", 5.0}}}},
    {"load_dependent_friction", {{{"coefficient", 0.0}}}},
    {"constant_torque", {{{"torque", 0.0}}}},
    {"spring_torque", {{{"stiffness", 0.0}, {"centre", 3.0}}}},
    {"cogging", {{{"cosine", 0.0}, {"sine", 0.0}, {"period", 10.0}}, 1e-12}},
    {"external_torque", {{{"torque", 0.0}, {"start", 0.1}, {"duration", 0.1}}}},
    {"torque_ripple", {{{"cosine", 0.0}, {"sine", 0.0}, {"period", 10.0}}, 1e-12}},
    // Hardly any mass behind a stiff spring.
    {"compliance", {{{"resonance", 1000.0}, {"damping_ratio", 1.0}, {"load_fraction", 0.02}}, 1e-2}},
    {"backlash", {{{"gap", 0.0}, {"resonance", 1000.0}, {"damping_ratio", 1.0}, {"load_fraction", 0.02}}, 1e-2}},
    {"input_delay", {{{"delay", 0.0}}}},
    {"current_loop_lag", {{{"bandwidth", 1e9}}, 1e-6}},
    {"current_saturation", {{{"limit", 1e6}}}},
    {"voltage_limit", {{{"stall", 1e6}, {"no_load_speed", 1e5}}}},
    {"dac_dead_zone", {{{"width", 0.0}}}},
    {"dac_offset", {{{"offset", 0.0}}}},
    {"tach_gain", {{{"gain", 1.0}}}},
    {"tach_offset", {{{"offset", 0.0}}}},
    {"tach_lag", {{{"bandwidth", 1e9}}, 1e-6}},
    {"tach_ripple", {{{"cosine", 0.0}, {"sine", 0.0}, {"period", 10.0}}}},
    {"encoder_cyclic_error", {{{"cosine", 0.0}, {"sine", 0.0}, {"period", 10.0}}}},
    {"pitch_error", {{{"cosine", 0.0}, {"sine", 0.0}, {"period", 10.0}}}},
    {"thermal_growth", {{{"growth", 0.0}, {"time_constant", 5.0}}}},
    {"free_curve", {{{"knot_0", 0.0}, {"value_0", 0.0}, {"knot_1", 1.0}, {"value_1", 0.0}}}},
};

TEST_P(EveryEffect, WithoutStrengthLeavesTheDriveAsItWas) {
  const EffectInfo& info = *GetParam();
  if (info.base) {
    Drive drive(coulomb_drive());
    EXPECT_GT(drive.inertia, 0.0);
    return;
  }
  const auto powerless = kPowerless.find(info.kind);
  ASSERT_NE(powerless, kPowerless.end()) << "add to kPowerless the parameters at which the new effect vanishes";
  const Drive plain(coulomb_drive());
  const Drive same(with(coulomb_drive(), std::string(info.kind), powerless->second.parameters));
  DriveState expected = plain.at(1.0, 0.0), state = same.at(1.0, 0.0);
  double x_error = 0.0, w_error = 0.0, x_most = 0.0, w_most = 0.0;
  for (int k = 0; k < 1500; ++k) {
    // Rests, starts, reversals: three tones that never repeat.
    const double u_V = k < 50 ? 0.3 : 1.2 * std::sin(0.011 * k) + 0.6 * std::sin(0.029 * k) + 0.2 * std::sin(0.17 * k);
    plain.step(expected, u_V, 0.001 * k, 0.001);
    same.step(state, u_V, 0.001 * k, 0.001);
    x_error = std::max(x_error, std::abs(same.encoder(state) - plain.encoder(expected)));
    w_error = std::max(w_error, std::abs(same.tachometer(state) - plain.tachometer(expected)));
    x_most = std::max(x_most, std::abs(expected.x));
    w_most = std::max(w_most, std::abs(expected.w));
  }
  ASSERT_GT(w_most, 5.0);
  // One rounding of a product with 1 or a sum with 0 is allowed for.
  EXPECT_LE(x_error, (powerless->second.tolerance + 1e-14) * x_most);
  EXPECT_LE(w_error, (powerless->second.tolerance + 1e-14) * w_most);
}

}  // namespace
