// The table of parameters: identity, ranges, and that each of them has an effect.
#include <gtest/gtest.h>

#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "firmware/app/parameters/parameter_check.hpp"
#include "firmware/core/axis.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/firmware/app/trip_points.hpp"

namespace {

using firmware::ParameterKey;
using firmware::ParameterValues;
using firmware::SetRefusal;
using firmware::ValueRefusal;
using firmware_test::kPaperX;
using firmware_test::paper_values;
using firmware_test::place_named;
using firmware_test::set;

sim::DriveDescription machine() {
  sim::DriveDescription drive;
  drive.data.amplifier_gain_A_per_V = kPaperX.amplifier_gain_A_per_V;
  drive.data.torque_constant_Nm_per_A = firmware_test::kMotorConstant_Nm_per_A;
  drive.data.lead = firmware_test::kLead_mm_per_rad;
  drive.data.dac_resolution_V = firmware_test::kDacResolution_V;
  drive.data.encoder_resolution = firmware_test::kEncoderResolution_mm;
  drive.data.tach_noise_variance = 0.0;
  drive.effects = {{"inertia", {{"J", kPaperX.inertia_kg_m2}}, {}, {}},
                   {"viscous", {{"B", kPaperX.viscous_Nm_s_per_rad}}, {}, {}}};
  return drive;
}

/// The complete effect of a set on the machine: whether it is refused, all codes of the converter in both directions of
/// motion, including limits and saturation, and the thresholds of the monitors.
template <typename Scalar>
std::pair<SetRefusal, std::vector<std::int32_t>> behaviour(const ParameterValues& values) {
  const SetRefusal problem = firmware::check<Scalar>(values);
  std::vector<std::int32_t> words;
  if (problem.kind != ValueRefusal::none || !values.axis(0).get<"drive.fitted">()) return {problem, words};
  sim::Plant plant(machine(), 1);
  hal::pc::SimulatedAxis wires(plant);
  firmware::Axis<Scalar, hal::pc::SimulatedAxis> axis(wires);
  constexpr std::array<firmware::PitchPoint, 3> kPitch{{{-40000, 0, 10 << 16}, {0, 50 << 16, 20 << 16}, {40000, 0, 0}}};
  axis.use_pitch_table(kPitch);
  EXPECT_EQ(axis.configure(firmware::axis_parameters<Scalar>(values.axis(0))), firmware::Refusal::none);
  for (int k = 0; k < 500; ++k) {
    if (k == 5) {
      axis.set_home(0);
      EXPECT_TRUE(axis.enable());
    }
    if (k == 10) axis.jog(Scalar(0.05F));  // crawls below the blending speed
    if (k == 40) axis.jog(Scalar(1000));
    if (k == 200) axis.jog(Scalar(-0.05F));
    if (k == 300) axis.jog(Scalar(-1000));
    words.push_back(axis.step().dac_code);
    plant.advance(1e-3);
  }
  const auto trips = firmware_test::trip_points(firmware::axis_parameters<Scalar>(values.axis(0)));
  words.insert(words.end(), trips.begin(), trips.end());
  return {problem, words};
}

float changed(const firmware::ParameterRule& rule, float value) {
  if (rule.type == firmware::ParameterType::toggle) return 1.0F - value;
  if (rule.type == firmware::ParameterType::whole) return value + 1.0F;
  const float up = value == 0.0F ? 0.1F : 1.1F * value;
  return up <= rule.maximum ? up : 0.9F * value;
}

template <typename Scalar>
class Parameters : public testing::Test {};
using Scalars = testing::Types<float, firmware::FixedPoint>;
TYPED_TEST_SUITE(Parameters, Scalars);

/// Every part of the compensation on, each large enough to show within the travel of behaviour().
void compensate(ParameterValues& values) {
  for (const char* part : {"cogging", "presliding", "position_friction", "backlash", "notch", "low_pass", "pitch"})
    set(values, std::string("x.") + part + ".on", 1);
  for (const char* harmonic : {"_1", "_2", "_3"}) {
    set(values, std::string("x.cogging.cosine") + harmonic, 0.3);
    set(values, std::string("x.cogging.sine") + harmonic, 0.2);
  }
  set(values, "x.cogging.period_2", 5);
  set(values, "x.cogging.period_3", 2.5);
  set(values, "x.presliding.stiffness", 150);
  set(values, "x.presliding.damping", 0.3);
  set(values, "x.position_friction.cosine", 0.2);
  set(values, "x.position_friction.sine", 0.1);
  set(values, "x.backlash.gap", 0.05);
  set(values, "x.backlash.wind_up", 0.005);
}

TYPED_TEST(Parameters, EachChangedAloneChangesWhatTheMachineNotices) {
  ParameterValues values = paper_values();
  set(values, "x.limits.velocity", 80);   // reached by the jogs
  set(values, "x.drive.dac_limit", 3.0);  // reached while they accelerate
  set(values, "x.monitor.polarity_command", 2.0);
  set(values, "x.monitor.oscillation", 1.5);
  const auto before = behaviour<TypeParam>(values);
  ASSERT_EQ(before.first, SetRefusal{});
  ParameterValues compensated = values;  // presliding replaces friction.blend
  compensate(compensated);
  const auto before_compensated = behaviour<TypeParam>(compensated);
  ASSERT_EQ(before_compensated.first, SetRefusal{});
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place) {
    if (firmware::key_at(place).owner() > 1) continue;  // y has the same rows
    // Need a host: BoardMotion.StopsWhenTheHostFallsSilent, TwoClients.AnAxisEnabledWithoutItsHostIsDropped.
    if (place == place_named("host.timeout") || place == place_named("host.standing_timeout") ||
        place == place_named("emergency_stop.delay") || place == place_named("probe.input"))
      continue;  // the last: probing_test.cpp
    const std::string_view name = firmware::kParameters[firmware::row_at(place)].name;
    if (name.starts_with("homing.") || name.starts_with("unfitted."))
      continue;  // homing_on_board_test.cpp, motion_owner_test.cpp
    if (name == "feedback.hold_effort" || name == "feedforward.friction_watch")
      continue;  // path_on_board_test.cpp, friction_watch_test.cpp
    if (name == "limits.unhomed_velocity" || name == "limits.fault_deceleration")
      continue;  // board_application_test.cpp; below
    if (name.starts_with("amplifier.") || name.starts_with("brake.") || name.starts_with("encoder."))
      continue;  // below
    const auto changes = [place](ParameterValues of, const auto& behaved) {
      of.set(place, changed(firmware::rule_at(place), of.at(place)));
      return behaviour<TypeParam>(of) != behaved;
    };
    EXPECT_TRUE(changes(values, before) || changes(compensated, before_compensated))
        << firmware::kParameters[firmware::row_at(place)].name;
  }
}

TYPED_TEST(Parameters, AmplifierAndBrakeAreWaitedForInControlPeriods) {
  ParameterValues values = paper_values();
  set(values, "x.encoder.index_spacing", 4096);
  EXPECT_EQ(firmware::axis_parameters<TypeParam>(values.axis(0)).monitors.index_spacing, 4096);
  set(values, "x.amplifier.ready_input", 1);
  set(values, "x.amplifier.ready_time", 0.25);
  set(values, "x.brake.fitted", 1);
  set(values, "x.brake.release_time", 0.04);
  set(values, "x.brake.apply_time", 0.06);
  const auto sequence = firmware::axis_parameters<TypeParam>(values.axis(0)).sequence;
  EXPECT_TRUE(sequence.ready_input);
  EXPECT_TRUE(sequence.brake_fitted);
  EXPECT_EQ(sequence.amplifier_wait, 250);
  EXPECT_EQ(sequence.brake_release, 40);
  EXPECT_EQ(sequence.brake_application, 60);
  EXPECT_EQ(firmware::check<TypeParam>(values), SetRefusal{});
  set(values, "x.amplifier.ready_time", 0);
  EXPECT_EQ(firmware::check<TypeParam>(values),
            (SetRefusal{ValueRefusal::refused_by_core, firmware::key_at(place_named("x.amplifier.ready_time"))}));
}

TYPED_TEST(Parameters, FaultsHaveADecelerationOfTheirOwn) {
  ParameterValues values = paper_values();
  const auto limits = [&values] { return motion_limits(firmware::axis_parameters<TypeParam>(values.axis(0))); };
  set(values, "x.limits.acceleration", 2000);
  set(values, "x.limits.fault_deceleration", 5000);
  EXPECT_NEAR(static_cast<double>(limits().fault_deceleration), 2.5 * static_cast<double>(limits().acceleration),
              1e-6 * static_cast<double>(limits().acceleration));
  EXPECT_EQ(firmware::check<TypeParam>(values), SetRefusal{});
  set(values, "x.limits.fault_deceleration", 1e8);
  EXPECT_EQ(firmware::check<TypeParam>(values),
            (SetRefusal{ValueRefusal::refused_by_core, firmware::key_at(place_named("x.limits.fault_deceleration"))}));
}

TYPED_TEST(Parameters, ASlowerControlRateIsTakenTogetherWithItsPeriod) {
  ParameterValues values = paper_values();
  set(values, "control.rate", 500);
  EXPECT_EQ(firmware::check<TypeParam>(values),
            (SetRefusal{ValueRefusal::rate_disagrees, firmware::key_at(place_named("x.drive.sample_period"))}));
  set(values, "x.drive.sample_period", 1.0 / 500);
  EXPECT_EQ(firmware::check<TypeParam>(values), SetRefusal{});
}

TYPED_TEST(Parameters, InitialValuesFitNoAxisAndAreAdmissible) {
  const ParameterValues initial;
  EXPECT_EQ(firmware::check<TypeParam>(initial), SetRefusal{});
  for (std::size_t axis = 0; axis < hal::kAxisCount; ++axis) EXPECT_FALSE(initial.axis(axis).get<"drive.fitted">());
}

TYPED_TEST(Parameters, AnAxisThatIsFittedButNotDesignedIsRefused) {
  ParameterValues values;
  set(values, "y.drive.fitted", 1);
  EXPECT_EQ(firmware::check<TypeParam>(values),
            (SetRefusal{ValueRefusal::refused_by_core, firmware::key_at(place_named("y.model.a12"))}));
}

TYPED_TEST(Parameters, ValuesBeyondTheirRangeAreNamed) {
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place) {
    const firmware::ParameterRule& rule = firmware::rule_at(place);
    const float infinity = std::numeric_limits<float>::infinity();
    for (const auto& [value, kind] :
         {std::pair{rule.maximum * 1.01F + 1.0F, ValueRefusal::above_maximum},
          std::pair{rule.minimum - std::abs(rule.minimum) * 0.01F - 1e-12F, ValueRefusal::below_minimum},
          std::pair{infinity, ValueRefusal::not_a_number}, std::pair{-infinity, ValueRefusal::not_a_number},
          std::pair{std::numeric_limits<float>::quiet_NaN(), ValueRefusal::not_a_number}}) {
      ParameterValues values = paper_values();
      values.set(place, value);
      EXPECT_EQ(firmware::check<TypeParam>(values), (SetRefusal{kind, firmware::key_at(place)})) << place;
    }
  }
}

TYPED_TEST(Parameters, CompensationThatMakesNoSenseIsRefusedOnlyWhereItIsOn) {
  for (const auto& [part, wrong, value] : {std::tuple{"cogging", "cogging.period_1", 1e-4},
                                           {"position_friction", "position_friction.period", 1e-4},
                                           {"presliding", "presliding.stiffness", 0.0},
                                           {"backlash", "backlash.gap", 0.0}}) {
    ParameterValues values = paper_values();
    compensate(values);
    set(values, std::string("x.") + wrong, value);
    EXPECT_EQ(firmware::check<TypeParam>(values),
              (SetRefusal{ValueRefusal::refused_by_core, firmware::key_at(place_named(std::string("x.") + wrong))}));
    set(values, std::string("x.") + part + ".on", 0);
    EXPECT_EQ(firmware::check<TypeParam>(values), SetRefusal{}) << part;
  }
}

/// The core identifies parameters only by their ids.
TEST(ParameterTable, HasTheParametersThatTheCoreRefuses) {
  using firmware::Refusal;
  for (const auto& [refusal, name] : {std::pair{Refusal::sample_period, "drive.sample_period"},
                                      {Refusal::lead, "drive.lead"},
                                      {Refusal::encoder_resolution, "drive.encoder_resolution"},
                                      {Refusal::dac_resolution, "drive.dac_resolution"},
                                      {Refusal::dac_limit, "drive.dac_limit"},
                                      {Refusal::tachometer_gain, "tachometer.gain"},
                                      {Refusal::drive_model, "model.a12"},
                                      {Refusal::kalman_gain, "kalman.k11"},
                                      {Refusal::estimator_poles, "kalman.k11"},
                                      {Refusal::state_feedback, "feedback.k1"},
                                      {Refusal::loop_poles, "feedback.k1"},
                                      {Refusal::friction_curve, "friction.static_positive"},
                                      {Refusal::friction_blend, "friction.blend"},
                                      {Refusal::velocity_limit, "limits.velocity"},
                                      {Refusal::acceleration_limit, "limits.acceleration"},
                                      {Refusal::jerk_limit, "limits.jerk"},
                                      {Refusal::jerk_time, "limits.jerk"},
                                      {Refusal::fault_deceleration, "limits.fault_deceleration"},
                                      {Refusal::following_error, "monitor.following_error"},
                                      {Refusal::disagreement, "monitor.disagreement"},
                                      {Refusal::overspeed, "monitor.overspeed"},
                                      {Refusal::polarity_command, "monitor.polarity_command"},
                                      {Refusal::travel, "monitor.travel_max"},
                                      {Refusal::saturation_time, "monitor.saturation_time"},
                                      {Refusal::oscillation, "monitor.oscillation"},
                                      {Refusal::cogging, "cogging.period_1"},
                                      {Refusal::presliding, "presliding.stiffness"},
                                      {Refusal::position_friction, "position_friction.period"},
                                      {Refusal::backlash, "backlash.gap"},
                                      {Refusal::backlash_crossing, "backlash.crossing_time"},
                                      {Refusal::pitch_crossing, "pitch.crossing_time"},
                                      {Refusal::homing, "homing.velocity"},
                                      {Refusal::amplifier_ready, "amplifier.ready_time"},
                                      {Refusal::brake_feedback, "brake.fitted"},
                                      {Refusal::index_spacing, "encoder.index_spacing"},
                                      {Refusal::filters, "notch.frequency"}}) {
    const auto* const row =
        std::ranges::find(firmware::kParameters, firmware::parameter_behind(refusal), &firmware::ParameterInfo::id);
    ASSERT_NE(row, firmware::kParameters.end()) << name;
    EXPECT_EQ(row->name, name);
  }
  for (const Refusal refusal : {Refusal::none, Refusal::controller_is_enabled, Refusal::move_too_long,
                                Refusal::outside_travel, Refusal::path_not_open, Refusal::path_full,
                                Refusal::path_too_fast, Refusal::path_ends_in_motion, Refusal::path_headroom})
    EXPECT_EQ(firmware::parameter_behind(refusal), 0);
}

TEST(ParameterTable, WholeNumbersAndSwitchesTakeNoFractions) {
  ParameterValues values;
  set(values, "control.rate", 1000.5);
  EXPECT_EQ(firmware::check<float>(values).kind, ValueRefusal::not_whole);
  set(values, "control.rate", 1000);
  set(values, "x.drive.fitted", 0.5);
  EXPECT_EQ(firmware::check<float>(values).kind, ValueRefusal::not_whole);
}

TEST(ParameterTable, KeysAndPlacesAreOneToOne) {
  for (std::size_t place = 0; place < firmware::parameter_count(hal::kAxisCount); ++place)
    EXPECT_EQ(firmware::place_of(firmware::key_at(place)), place);
  EXPECT_EQ(firmware::place_of(ParameterKey{0}), std::nullopt);
  EXPECT_EQ(firmware::place_of(ParameterKey::of_board(0xFFF)), std::nullopt);
  EXPECT_EQ(firmware::place_of(ParameterKey::of_axis(0, 1)), std::nullopt) << "control.rate belongs to the board";
  EXPECT_EQ(firmware::place_of(ParameterKey::of_board(64)), std::nullopt) << "kalman.k11 belongs to an axis";
  EXPECT_EQ(firmware::place_of(ParameterKey::of_axis(hal::kMostAxes, 64)), std::nullopt);
  EXPECT_EQ(ParameterValues(1).place_of(ParameterKey::of_axis(1, 64)), std::nullopt) << "the board has one axis";
}

/// Ids as released; a row may be removed, but its id is never reused.
TEST(ParameterTable, IdsAreFrozen) {
  const std::pair<std::uint16_t, const char*> kReleased[] = {
      {1, "control.rate"},
      {2, "host.timeout"},
      {16, "drive.fitted"},
      {17, "drive.sample_period"},
      {18, "drive.lead"},
      {19, "drive.encoder_resolution"},
      {20, "drive.dac_resolution"},
      {21, "drive.dac_limit"},
      {22, "drive.effort_per_volt"},
      {32, "tachometer.fitted"},
      {33, "tachometer.gain"},
      {34, "tachometer.offset"},
      {48, "model.a12"},
      {49, "model.a22"},
      {50, "model.b1"},
      {51, "model.b2"},
      {64, "kalman.k11"},
      {65, "kalman.k12"},
      {66, "kalman.k21"},
      {67, "kalman.k22"},
      {68, "kalman.k31"},
      {69, "kalman.k32"},
      {80, "feedback.k1"},
      {81, "feedback.k2"},
      {82, "feedback.cancel_disturbance"},
      {96, "feedforward.zero_phase"},
      {97, "feedforward.friction"},
      {112, "friction.static_positive"},
      {113, "friction.coulomb_positive"},
      {114, "friction.viscous_positive"},
      {115, "friction.omega1_positive"},
      {116, "friction.omega2_positive"},
      {117, "friction.static_negative"},
      {118, "friction.coulomb_negative"},
      {119, "friction.viscous_negative"},
      {120, "friction.omega1_negative"},
      {121, "friction.omega2_negative"},
      {122, "friction.blend"},
      {128, "limits.velocity"},
      {129, "limits.acceleration"},
      {130, "limits.jerk"},
      {160, "calibration.tachometer_gain"},
      {161, "calibration.tachometer_offset"},
      {176, "cogging.on"},
      {177, "cogging.cosine_1"},
      {178, "cogging.sine_1"},
      {179, "cogging.period_1"},
      {180, "cogging.cosine_2"},
      {181, "cogging.sine_2"},
      {182, "cogging.period_2"},
      {183, "cogging.cosine_3"},
      {184, "cogging.sine_3"},
      {185, "cogging.period_3"},
      {192, "presliding.on"},
      {193, "presliding.stiffness"},
      {194, "presliding.damping"},
      {208, "position_friction.on"},
      {209, "position_friction.cosine"},
      {210, "position_friction.sine"},
      {211, "position_friction.period"},
      {224, "backlash.on"},
      {225, "backlash.gap"},
      {226, "backlash.crossing_time"},
      {227, "backlash.wind_up"},
      {288, "pitch.on"},
      {289, "pitch.crossing_time"},
  };
  for (const auto& [id, name] : kReleased)
    for (const firmware::ParameterInfo& row : firmware::kParameters)
      EXPECT_EQ(row.id == id, row.name == name) << row.id << " " << row.name;
}

TEST(ParameterTable, SchemaHashSeesEveryFieldButTheDocumentation) {
  using firmware::ParameterInfo;
  const auto hash_after = [](auto change) {
    std::vector<ParameterInfo> rows(firmware::kParameters.begin(), firmware::kParameters.end());
    change(rows[20]);
    return firmware::parameter_rows::schema_hash(rows);
  };
  EXPECT_EQ(hash_after([](ParameterInfo& row) { row.doc = "in other words"; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.id = 4000; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.name = "other"; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.unit = "kV"; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.type = firmware::ParameterType::whole; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.scope = firmware::ParameterScope::board; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.change = firmware::ParameterChange::any_time; }),
            firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.minimum = -1e9F; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.maximum = 1e9F; }), firmware::kSchemaHash);
  EXPECT_NE(hash_after([](ParameterInfo& row) { row.initial = 0.125F; }), firmware::kSchemaHash);
}

}  // namespace
