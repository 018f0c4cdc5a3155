// Open-loop steps on a plant that follows Table 1 of the paper, at the paper's seven scalings of the input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/identify/excitation.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/paper_drives.hpp"

namespace {

using host::IdentificationMethod;
using testing::HasSubstr;

// Table 1, typed again, so that a typing error in the description of the drive shows.
struct Truth {
  const char* axis;
  double J, B, coulomb[2];
};
constexpr Truth kTruths[] = {{"x", 7.65e-3, 0.0321, {2.205, -1.656}}, {"y", 9.79e-3, 0.0287, {3.058, -2.739}}};

sim::DriveDescription data_sheet_of(const char* axis) { return host::data_sheet_of(*host::paper_drive(axis)); }

host::Record steps(const char* axis, double Ku) {
  return host::record_open_loop(*host::paper_drive(axis), host::doublet_series(Ku * host::kStepUnit_V, 0.001), 1);
}

/// The record of a logger with half the rate.
host::Record every_second_row(const host::Record& record) {
  host::Record coarse = record;
  coarse.sample_period_s *= 2.0;
  for (std::vector<double> host::Record::*column :
       {&host::Record::t_s, &host::Record::u_V, &host::Record::x, &host::Record::w, &host::Record::i_A}) {
    std::vector<double>& values = coarse.*column;
    for (std::size_t k = 0; 2 * k < values.size(); ++k) values[k] = values[2 * k];
    values.resize((values.size() + 1) / 2);
  }
  return coarse;
}

class StepIdentification : public testing::TestWithParam<Truth> {};

TEST_P(StepIdentification, IsRefusedWhereTheAxisStandsStill) {
  for (const double Ku : {1.0, 2.5}) {
    for (const auto method :
         {IdentificationMethod::simple_ls, IdentificationMethod::unbiased_ls, IdentificationMethod::sliding_ls}) {
      try {
        host::identify_drive(host::MeasurementGate(data_sheet_of(GetParam().axis)).admit({steps(GetParam().axis, Ku)}),
                             data_sheet_of(GetParam().axis), method);
        FAIL() << "accepted Ku = " << Ku;
      } catch (const host::Failure& failure) {
        EXPECT_EQ(failure.code, host::ExitCode::refused);
        EXPECT_THAT(failure.what(), HasSubstr("did not move enough"));
        EXPECT_THAT(failure.what(), HasSubstr("both directions"));
        EXPECT_THAT(failure.what(), HasSubstr(Ku == 1.0 ? "±0.6 V" : "±1.5 V"));
      }
    }
  }
}

/// The paper's method stacks samples; the method with a filter uses each record at its own rate.
TEST_P(StepIdentification, TakesRecordsOfSeveralRates) {
  const Truth& truth = GetParam();
  const sim::DriveDescription sheet = data_sheet_of(truth.axis);
  const host::Record whole = steps(truth.axis, 5.0), coarse = every_second_row(steps(truth.axis, 7.5));
  const host::Measurements measured = host::MeasurementGate(sheet).admit({whole, coarse});
  const host::Identification found = host::identify_drive(measured, sheet, IdentificationMethod::sliding_ls);
  EXPECT_NEAR(found.model.find("inertia")->at("J"), truth.J, 0.02 * truth.J);
  EXPECT_NEAR(found.model.find("coulomb")->at("positive"), truth.coulomb[0], 0.05 * truth.coulomb[0]);
  try {
    host::identify_drive(measured, sheet, IdentificationMethod::unbiased_ls);
    FAIL() << "samples of two rates were stacked";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("--method sliding-ls"));
  }
}

/// A logger whose clock jitters by 0.4 ms at 60 Hz logs positions with wrong times. Differentiated twice, the error is
/// as large as the acceleration. The tachometer is better.
TEST_P(StepIdentification, TakesTheMotionFromTheSpeedWhereThePositionJitters) {
  const Truth& truth = GetParam();
  const sim::DriveDescription sheet = data_sheet_of(truth.axis);
  host::Record jittery = steps(truth.axis, 7.5);
  for (std::size_t k = 0; k < jittery.size(); ++k)
    jittery.x[k] += sheet.data.lead * jittery.w[k] * 0.4e-3 * std::sin(2.0 * std::numbers::pi * 60.0 * jittery.t_s[k]);
  const host::Measurements measured = host::MeasurementGate(sheet).admit({jittery});
  const host::Identification found = host::identify_drive(measured, sheet, IdentificationMethod::sliding_ls);
  EXPECT_TRUE(found.by_speed);
  EXPECT_NEAR(found.model.find("inertia")->at("J"), truth.J, 0.03 * truth.J);
  EXPECT_NEAR(found.model.find("coulomb")->at("positive"), truth.coulomb[0], 0.05 * truth.coulomb[0]);
  const host::Measurements clean = host::MeasurementGate(sheet).admit({steps(truth.axis, 7.5)});
  EXPECT_FALSE(host::identify_drive(clean, sheet, IdentificationMethod::sliding_ls).by_speed);
}

TEST_P(StepIdentification, ARecordTooSlowOrTooShortIsBadInput) {
  const auto message_of = [](const host::Record& record) {
    try {
      host::identify_drive(host::MeasurementGate(data_sheet_of(GetParam().axis)).admit({record}),
                           data_sheet_of(GetParam().axis), IdentificationMethod::sliding_ls);
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::bad_input);
      return std::string(failure.what());
    }
    return std::string("no failure");
  };
  host::Record record = steps(GetParam().axis, 10.0);
  for (std::vector<double>* column : {&record.t_s, &record.u_V, &record.x, &record.w}) column->resize(150);
  EXPECT_THAT(message_of(record), testing::AllOf(HasSubstr("lasts 0.15 s"), HasSubstr("record 0.2 s or more")));
  record.sample_period_s = 0.05;
  EXPECT_THAT(message_of(record), testing::AllOf(HasSubstr("sampled at 20 Hz"), HasSubstr("50 Hz or faster")));
}

TEST_P(StepIdentification, WarnsWhereStaticFrictionDominates) {
  for (const auto method : {IdentificationMethod::unbiased_ls, IdentificationMethod::sliding_ls}) {
    const auto found =
        host::identify_drive(host::MeasurementGate(data_sheet_of(GetParam().axis)).admit({steps(GetParam().axis, 5.0)}),
                             data_sheet_of(GetParam().axis), method);
    EXPECT_THAT(found.warnings, testing::Contains(HasSubstr("static friction dominates")));
  }
}

TEST_P(StepIdentification, UnbiasedEstimateHoldsFromKu10AndSimpleOneIsWorse) {
  const Truth& truth = GetParam();
  for (const double Ku : {10.0, 12.5, 15.0}) {
    SCOPED_TRACE(Ku);
    const host::Record record = steps(truth.axis, Ku);
    const auto unbiased = host::identify_drive(host::MeasurementGate(data_sheet_of(truth.axis)).admit({record}),
                                               data_sheet_of(truth.axis), IdentificationMethod::unbiased_ls);
    EXPECT_THAT(unbiased.warnings, testing::Not(testing::Contains(HasSubstr("static friction"))));
    EXPECT_NEAR(unbiased.estimate.inertia.value, truth.J, 0.02 * truth.J);
    EXPECT_NEAR(unbiased.estimate.viscous.value, truth.B, 0.20 * truth.B);
    EXPECT_NEAR(unbiased.estimate.positive->value, truth.coulomb[0], 0.12 * truth.coulomb[0]);
    EXPECT_NEAR(unbiased.estimate.negative->value, truth.coulomb[1], -0.12 * truth.coulomb[1]);

    const auto simple = host::identify_drive(host::MeasurementGate(data_sheet_of(truth.axis)).admit({record}),
                                             data_sheet_of(truth.axis), IdentificationMethod::simple_ls);
    // The paper, (41) and (42): if friction is left out, J and B become too large, B by several times.
    EXPECT_GT(simple.estimate.inertia.value, 1.01 * unbiased.estimate.inertia.value);
    EXPECT_GT(simple.estimate.viscous.value, 1.5 * unbiased.estimate.viscous.value);
    EXPECT_GT(simple.relative_error, 3.0 * unbiased.relative_error);
  }
}

TEST_P(StepIdentification, SlidingEstimateIsFreeOfTheTachometersBias) {
  const Truth& truth = GetParam();
  const auto found =
      host::identify_drive(host::MeasurementGate(data_sheet_of(truth.axis))
                               .admit({steps(truth.axis, 10.0), steps(truth.axis, 12.5), steps(truth.axis, 15.0)}),
                           data_sheet_of(truth.axis), IdentificationMethod::sliding_ls);
  EXPECT_NEAR(found.estimate.inertia.value, truth.J, 0.005 * truth.J);
  EXPECT_NEAR(found.estimate.viscous.value, truth.B, 0.05 * truth.B);
  EXPECT_NEAR(found.estimate.positive->value, truth.coulomb[0], 0.05 * truth.coulomb[0]);
  EXPECT_NEAR(found.estimate.negative->value, truth.coulomb[1], -0.05 * truth.coulomb[1]);
}

INSTANTIATE_TEST_SUITE_P(PaperAxes, StepIdentification, testing::ValuesIn(kTruths),
                         [](const auto& truth) { return std::string(truth.param.axis); });

}  // namespace
