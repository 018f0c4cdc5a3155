// Results of a sensor on the table, from motions and differences in closed form.
#include "host/scale/table_study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace {

constexpr double kPeriod_s = 2e-3, kLead = 1.5915, kKt = 0.5;
constexpr int kRows = 8000;

/// Difference between motor and table, mm, as a function of the motor's position, the torque in Nm and the time.
using Difference = std::function<double(double x, double torque, double t_s)>;

sim::DriveDescription drive() {
  sim::DriveDescription model;
  model.data.torque_constant_Nm_per_A = kKt;
  model.data.amplifier_gain_A_per_V = 1.0;
  model.data.lead = kLead;
  model.data.sample_period_s = kPeriod_s;
  model.data.encoder_resolution = 1e-4;
  model.effects = {{.kind = "inertia", .parameters = {{"J", 0.01}}, .ci95 = {}, .from = {}},
                   {.kind = "coulomb", .parameters = {{"level", 1.0}}, .ci95 = {}, .from = {}}};
  return model;
}

/// The faster wave decelerates more than the friction of a table does.
struct Motion {
  double fast_mm = 14.0, fast_rad_s = 3.1;
  double at(double t_s) const { return 60.0 * std::sin(0.7 * t_s) + fast_mm * std::sin(fast_rad_s * t_s); }
};

/// `seed`: of the noise of the current and of the scale.
host::Record record(const Difference& difference, unsigned seed, const Motion& motor = {}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  host::Record made;
  made.drive = "x";
  made.sample_period_s = kPeriod_s;
  for (int k = 0; k < kRows; ++k) {
    const double t = kPeriod_s * k + 5.0 * seed, step = 1e-3;
    const double x = motor.at(t), v = (motor.at(t + step) - motor.at(t - step)) / (2.0 * step);
    const double a = (motor.at(t + step) - 2.0 * x + motor.at(t - step)) / (step * step);
    const double torque = 0.01 * a / kLead + (v > 0.0 ? 1.0 : -1.0);
    made.t_s.push_back(kPeriod_s * k);
    made.i_A.push_back(torque / kKt + 0.01 * noise(random));
    made.x.push_back(std::floor(x / 1e-4) * 1e-4);
    made.x2.push_back(std::floor((x + difference(x, torque, t) + 5e-5 * noise(random)) / 2e-4) * 2e-4);
  }
  return made;
}

host::TableStudy study(const Difference& training, const Difference& judging, const Motion& motor = {}) {
  static std::vector<host::Record> kept;
  kept = {record(training, 1, motor), record(judging, 2, motor)};
  return host::study_table(drive(), {&kept[0], &kept[1]});
}

/// The table in a gap of this width, mm, starting in its middle. It rests until it is pushed.
Difference gap_of(double gap) {
  return [gap, table = std::optional<double>()](double x, double, double) mutable {
    if (!table) table = x;
    table = std::clamp(*table, x - 0.5 * gap, x + 0.5 * gap);
    return *table - x;
  };
}

TEST(TableStudy, FollowsWithinItsNoise) {
  const Difference none = [](double, double, double) { return 0.0; };
  const host::TableStudy found = study(none, none);
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(found.effects.empty()) << host::table_words(found);
  EXPECT_LT(found.probability("backlash").value_or(1.0), 0.5);
}

TEST(TableStudy, IsEmptyWithoutASecondPosition) {
  host::Record plain = record([](double, double, double) { return 0.0; }, 1);
  plain.x2.clear();
  EXPECT_TRUE(host::study_table(drive(), {&plain}).empty());
}

/// Only the data sheet separates a scale whose zero moves by 3 um per kelvin from a motion of the table.
TEST(TableStudy, TakesTheScaleWarmingFromTheSheet) {
  const auto warming = [](unsigned seed) {
    host::Record warmed = record([](double, double, double) { return 0.0; }, seed);
    for (std::size_t k = 0; k < warmed.size(); ++k) {
      warmed.temp_C.push_back(20.0 + 4.0 * (1.0 - std::exp(-warmed.t_s[k] / 5.0)));
      warmed.x2[k] += 0.003 * (warmed.temp_C[k] - 20.0);
    }
    return warmed;
  };
  const host::Record train = warming(1), judge = warming(2);
  EXPECT_NE(host::study_table(drive(), {&train, &judge}).find("thermal_growth"), nullptr);
  sim::DriveDescription known = drive();
  known.data.load_encoder_resolution = 2e-4;
  known.data.load_encoder_offset_per_K = 0.003;
  const host::TableStudy found = host::study_table(known, {&train, &judge});
  EXPECT_TRUE(found.effects.empty()) << host::table_words(found);
}

TEST(TableStudy, MeasuresAGap) {
  const host::TableStudy found = study(gap_of(0.012), gap_of(0.012));
  ASSERT_EQ(found.effects.size(), 1U) << host::table_words(found);
  EXPECT_EQ(found.effects[0].group, std::vector<std::string>{"backlash"});
  EXPECT_NEAR(found.effects[0].sizes[0].value, 12.0, 0.3);
  EXPECT_TRUE(found.effects[0].worth_naming);
  EXPECT_LT(found.left_um, 0.2 * found.before_um);
}

/// The table on a spring with a free gap, integrated in steps of 20 us: inertia 0.006 kg m^2 and Coulomb friction of
/// 0.9 Nm at the table, 3 um/Nm, little damping.
Difference sprung(double gap) {
  struct Table {
    double y, w = 0.0, x, t_s;
  };
  return [gap, table = std::optional<Table>()](double x, double, double t_s) mutable {
    constexpr double kInertia = 0.006 / kLead, kStiffness = 1.0 / 0.003, kFriction = 0.9, kDamping = 0.15;
    if (!table) table = Table{.y = x, .x = x, .t_s = t_s};
    constexpr int kSteps = 100;
    const double step = (t_s - table->t_s) / kSteps, speed = step > 0.0 ? (x - table->x) / (t_s - table->t_s) : 0.0;
    for (int k = 0; k < kSteps; ++k) {
      table->x += speed * step;
      const double bend = table->x - table->y, bent = bend - std::clamp(bend, -0.5 * gap, 0.5 * gap);
      double force = bent == 0.0 ? 0.0 : kStiffness * bent + kDamping * (speed - table->w);
      if (gap > 0.0 && force * bent < 0.0) force = 0.0;  // a contact does not pull
      table->w += step * force / kInertia;
      const double stopped = step * kFriction / kInertia;
      table->w = std::abs(table->w) > stopped ? table->w - std::copysign(stopped, table->w) : 0.0;
      table->y += step * table->w;
    }
    table->t_s = t_s;
    return table->y - x;
  };
}

/// Catches a study that takes every difference between the directions for a gap.
TEST(TableStudy, TellsASpringFromAGap) {
  const host::TableStudy found = study(sprung(0.0), sprung(0.0));
  ASSERT_EQ(found.effects.size(), 1U) << host::table_words(found);
  EXPECT_EQ(found.effects[0].group, std::vector<std::string>{"compliance"});
  EXPECT_LT(found.probability("backlash").value_or(1.0), 0.05);
  const double resonance = std::sqrt(1.0 / 0.003 / (0.006 / kLead)) / (2.0 * std::numbers::pi);
  EXPECT_NEAR(found.effects[0].sizes.back().value, resonance, 0.02 * resonance);
}

/// Catches a gap that is measured from the reversal of the motor, and not from the point at which the spring is
/// relaxed.
TEST(TableStudy, MeasuresAGapBesideASpring) {
  const Motion softer_than_friction{}, harder{.fast_mm = 10.0, .fast_rad_s = 9.0};
  for (const Motion& motor : {softer_than_friction, harder}) {
    const host::TableStudy found = study(sprung(0.012), sprung(0.012), motor);
    ASSERT_EQ(found.effects.size(), 2U) << host::table_words(found);
    ASSERT_NE(found.find("backlash"), nullptr);
    ASSERT_NE(found.find("compliance"), nullptr);
    EXPECT_NEAR(found.find("backlash")->sizes[0].value, 12.0, 0.6);
    EXPECT_NEAR(found.find("compliance")->sizes[0].value, 3.0, 0.3);
  }
}

/// Catches rows that extend beyond their record; here each sample is a row.
TEST(TableStudy, ReadsShortRecords) {
  host::Record whole = record(gap_of(0.03), 1);
  for (std::vector<double>* channel : {&whole.t_s, &whole.i_A, &whole.x, &whole.x2}) channel->resize(2001);
  const host::TableStudy found = host::study_table(drive(), {&whole});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.rows.records[0].stride, 1U);
  for (const Eigen::VectorXd* values : {&found.rows.y, &found.rows.v, &found.rows.a, &found.rows.effort}) {
    EXPECT_EQ(values->size(), 2000);
    EXPECT_TRUE(values->allFinite());
  }
  ASSERT_NE(found.find("backlash"), nullptr) << host::table_words(found);
  EXPECT_NEAR(found.find("backlash")->sizes[0].value, 30.0, 1.0);
}

TEST(TableStudy, DrawsThePitchError) {
  const Difference pitch = [](double x, double, double) { return 40e-6 * x + 0.003 * std::sin(x / 17.0); };
  const host::TableStudy found = study(pitch, pitch);
  ASSERT_EQ(found.effects.size(), 1U) << host::table_words(found);
  ASSERT_EQ(found.effects[0].group, std::vector<std::string>{"pitch_error"});
  double mean = 0.0;
  for (const host::TablePoint& point : found.effects[0].curve)
    mean += 1e3 * pitch(point.x_mm, 0.0, 0.0) / static_cast<double>(found.effects[0].curve.size());
  for (const host::TablePoint& point : found.effects[0].curve)
    EXPECT_NEAR(point.um, 1e3 * pitch(point.x_mm, 0.0, 0.0) - mean, 0.5) << point.x_mm;
}

TEST(TableStudy, SaysWhichSensorErrs) {
  const Difference scale = [](double x, double, double) { return 0.001 * std::sin(2.0 * std::numbers::pi * x / 2.3); };
  const host::TableStudy of_scale = study(scale, scale);
  ASSERT_EQ(of_scale.effects.size(), 1U) << host::table_words(of_scale);
  EXPECT_EQ(of_scale.effects[0].place, "scale");
  EXPECT_NEAR(of_scale.effects[0].sizes[0].value, 1.0, 0.1);
  EXPECT_NEAR(of_scale.effects[0].sizes[1].value, 2.3, 0.01);
  const double turn = 2.0 * std::numbers::pi * kLead;
  const Difference motor = [=](double x, double, double) {
    return 0.002 * std::cos(4.0 * std::numbers::pi * x / turn);
  };
  const host::TableStudy of_motor = study(motor, motor);
  ASSERT_EQ(of_motor.effects.size(), 1U) << host::table_words(of_motor);
  EXPECT_EQ(of_motor.effects[0].place, "motor");
}

/// Catches a search that ends at the period that a quarter of the rows resolves. Here the fastest rows cover many
/// periods of the grating, and only those near the reversals cover less than a third of one.
TEST(TableStudy, FindsAGratingThatOnlySlowMotionResolves) {
  const Difference scale = [](double x, double, double) { return 0.001 * std::sin(2.0 * std::numbers::pi * x / 0.15); };
  const host::TableStudy found = study(scale, scale);
  ASSERT_EQ(found.effects.size(), 1U) << host::table_words(found);
  EXPECT_EQ(found.effects[0].place, "scale");
  EXPECT_NEAR(found.effects[0].sizes[0].value, 1.0, 0.1);
  EXPECT_NEAR(found.effects[0].sizes[1].value, 0.15, 0.001);
}

/// Catches a drift that is taken for a pitch error or a gap, and a stated location of the drift, which no scale can
/// show.
TEST(TableStudy, NamesAGrowthAndNotItsPlace) {
  const Difference warming = [first = std::optional<double>()](double, double, double t_s) mutable {
    if (!first) first = t_s;
    return -0.012 * std::expm1(-(t_s - *first) / 6.0);
  };
  const host::TableStudy found = study(warming, warming);
  ASSERT_EQ(found.effects.size(), 1U) << host::table_words(found);
  EXPECT_EQ(found.effects[0].group, std::vector<std::string>{"thermal_growth"});
  EXPECT_NEAR(found.effects[0].sizes[0].value, 12.0, 0.5);
  EXPECT_NE(found.effects[0].words.find("the scale's own mount"), std::string::npos);
}

TEST(TableStudy, WhatTheModelHoldsIsNotMissing) {
  const Difference pitch = [](double x, double, double) {
    return 40e-6 * x + 0.003 * std::sin(2.0 * std::numbers::pi * x / 90.0);
  };
  const std::vector<host::Record> kept = {record(pitch, 1)};
  sim::DriveDescription model = drive();
  model.effects.push_back({.kind = "pitch_error",
                           .parameters = {{"lead_error", 40.0}, {"cosine", 0.0}, {"sine", 0.003}, {"period", 90.0}},
                           .ci95 = {},
                           .from = {}});
  EXPECT_TRUE(host::study_table(model, {&kept[0]}).effects.empty());
}

}  // namespace
