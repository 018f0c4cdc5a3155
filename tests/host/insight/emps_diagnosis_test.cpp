// What is missing from the published model of a real drive (EMPS, Janot, Gautier, Brunot 2019). The records are not
// part of the project; the test skips where they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "host/identify/identification.hpp"
#include "host/insight/diagnosis.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/import.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

const std::filesystem::path kEmps = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "emps";

host::Record read(const char* file, const sim::DataSheet& data) {
  host::ImportOptions options;
  options.mappings = host::parse_mappings("t_s=t,x_m=qm,u_V=vir");
  host::Record record = host::import_record(host::read_log((kEmps / file).string()), options);
  host::adapt_to(record, data);
  return record;
}

TEST(EmpsDiagnosis, SuggestsTheViscousAsymmetryAndNoPositionEffect) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kEmps)) GTEST_SKIP() << kEmps << " is absent";
  sim::DriveDescription drive;
  drive.name = "emps";
  drive.data.kind = sim::DriveKind::linear;
  drive.data.force_constant_N_per_V = 35.1507;  // `gtau` in the data, rounded as published
  drive.data.encoder_resolution = 5e-8;         // m; the smallest step in the data
  drive.data.dac_limit_V = 10.0;
  const host::Record train = read("DATA_EMPS.mat", drive.data), validate = read("DATA_EMPS_PULSES.mat", drive.data);
  const auto identified = host::identify_drive({train}, drive, host::IdentificationMethod::unbiased_ls);
  const host::Diagnosis diagnosis = host::diagnose(identified.model, {&train}, {&validate});
  EXPECT_TRUE(diagnosis.rough);
  EXPECT_EQ(diagnosis.verdict.status, host::Status::missing);
  // Recomputed from the published data: 166.71 and 240.42 N s/m, so -36.9 on 203.6; and the offset of -3.16 N vanishes.
  EXPECT_THAT(diagnosis.verdict.effects, testing::ElementsAre("viscous_asymmetry"));
  const sim::EffectEntry* asymmetry = diagnosis.best.find("viscous_asymmetry");
  ASSERT_NE(asymmetry, nullptr);
  EXPECT_NEAR(asymmetry->at("asymmetry"), -36.9 / 203.6, 0.03);
  const sim::EffectEntry* coulomb = diagnosis.best.find("coulomb");
  EXPECT_LT(std::abs(0.5 * (coulomb->at("positive") + coulomb->at("negative"))), 0.5);
  EXPECT_THAT(diagnosis.verdict.next_experiment, testing::HasSubstr("No record holds a constant speed between"));
  // Both runs have a ripple of 2.5 mm, of one amplitude and 95 degrees apart.
  EXPECT_THAT(diagnosis.verdict.explanation,
              testing::AllOf(testing::HasSubstr("A ripple every 2.5"), testing::HasSubstr("does not transfer")));
}

}  // namespace
