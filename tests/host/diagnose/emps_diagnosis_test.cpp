// Effects that are missing in the published model of a real drive (EMPS, Janot, Gautier, Brunot 2019). The records are
// not part of the project; the test is skipped if they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "host/diagnose/improvement.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/import/import_record.hpp"
#include "host/record/channel_checks.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::UnorderedElementsAre;

const std::filesystem::path kEmps = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "emps";

host::Record read(const char* file, const sim::DataSheet& data) {
  host::ImportOptions options;
  options.mappings = host::parse_mappings("t_s=t,x_m=qm,u_V=vir");
  host::Record record = host::import_record(host::read_log((kEmps / file).string()), options);
  host::adapt_to(record, data);
  return record;
}

TEST(EmpsDiagnosis, FindsTheViscousAsymmetryAndTheTwoThatHideEachOther) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kEmps)) GTEST_SKIP() << kEmps << " is absent";
  sim::DriveDescription drive;
  drive.name = "emps";
  drive.data.kind = sim::DriveKind::linear;
  drive.data.force_constant_N_per_V = 35.1507;  // `gtau` in the data, rounded as published
  drive.data.encoder_resolution = 5e-8;         // m; the smallest step in the data
  drive.data.dac_limit_V = 10.0;
  const host::Record train = read("DATA_EMPS.mat", drive.data), validate = read("DATA_EMPS_PULSES.mat", drive.data);
  const auto identified =
      host::identify_drive(host::MeasurementGate(drive).admit({train}), drive, host::IdentificationMethod::unbiased_ls);
  const host::Measurements measured = host::MeasurementGate(identified.model).admit({train}, {validate});
  const host::Improvement improvement = host::improve(identified.model, measured);

  const host::Diagnosis& first = improvement.first;
  EXPECT_TRUE(first.rough);
  EXPECT_EQ(first.measure, host::Measure::effort);
  EXPECT_EQ(first.verdict.status, host::Status::missing);
  // From the published data: 166.71 and 240.42 N s/m, a difference of -36.9 from the mean 203.6; the offset of -3.16 N
  // vanishes.
  EXPECT_THAT(first.verdict.effects, UnorderedElementsAre("viscous_asymmetry", "nonlinear_viscous", "input_delay"));
  const sim::EffectEntry* asymmetry = first.best.find("viscous_asymmetry");
  ASSERT_NE(asymmetry, nullptr);
  EXPECT_NEAR(asymmetry->at("asymmetry"), -36.9 / 203.6, 0.02);
  const sim::EffectEntry* coulomb = first.best.find("coulomb");
  EXPECT_LT(std::abs(0.5 * (coulomb->at("positive") + coulomb->at("negative"))), 0.5);
  for (const char* id : {"positive", "negative"}) EXPECT_NEAR(std::abs(coulomb->at(id)), 20.4, 3.0);
  // Half a sample of the converter's hold is not included; regressions of the published data give 0.86 ms with it.
  EXPECT_NEAR(first.best.find("input_delay")->at("delay"), 0.36e-3, 0.15e-3);
  EXPECT_EQ(improvement.ladder.size(), 4u) << "base and these three: nothing more";
  ASSERT_TRUE(first.screen != nullptr && first.screen->repeatable.has_value());
  EXPECT_NEAR(first.screen->repeatable->share, 0.64, 0.1);
  // The errors of a regression with these three effects on the published data: 2.138 % and 2.798 %.
  EXPECT_LE(host::relative_error(improvement.model, train), 0.0215);
  EXPECT_LE(host::relative_error(improvement.model, validate), 0.0285);
}

}  // namespace
