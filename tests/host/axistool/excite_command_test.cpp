// axistool excite on simulated boards that have no parameters of their drives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "host/record/read_record.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

/// All differ from the board's initial parameters and from the paper's drive.
struct Drive {
  const char* name;
  const char* data_sheet;
  const char* effects;
  const char* box;
  const char* inertia;  ///< its name in an identification
  double J, positive, negative;
};

const Drive kDrives[] = {
    {"heavy",
     "kind = \"rotary\"\namplifier_gain_A_per_V = 2.0\ntorque_constant_Nm_per_A = 1.1\nlead_mm_per_rad = 3.2\n"
     "sample_period_s = 0.001\n[drive.dac]\nresolution_V = 0.00030517578125\nlimit_V = 10.0\n[drive.encoder]\n"
     "resolution_mm = 0.0005\n[drive.tach]\nnoise_variance_rad2_s2 = 0.01\n",
     "[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = 0.031\n[[effect]]\nkind = \"viscous\"\nB_Nm_s_per_rad = 0.08\n"
     "[[effect]]\nkind = \"coulomb\"\npositive_Nm = 4.1\nnegative_Nm = -3.3\n",
     "travel=120,speed=200,volts=6,time=6", "J_kg_m2", 0.031, 4.1, -3.3},
    {"light, encoder alone",
     "kind = \"rotary\"\namplifier_gain_A_per_V = 0.5\ntorque_constant_Nm_per_A = 0.08\nlead_mm_per_rad = 0.8\n"
     "sample_period_s = 0.001\n[drive.dac]\nresolution_V = 0.0048828125\nlimit_V = 10.0\n[drive.encoder]\n"
     "resolution_mm = 0.0001\n",
     "[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = 0.0004\n[[effect]]\nkind = \"viscous\"\nB_Nm_s_per_rad = 0.0004\n"
     "[[effect]]\nkind = \"coulomb\"\npositive_Nm = 0.06\nnegative_Nm = -0.05\n",
     "travel=60,speed=120,volts=5,time=6", "J_kg_m2", 0.0004, 0.06, -0.05},
    {"linear, in metres",
     "kind = \"linear\"\nforce_constant_N_per_V = 30.0\nsample_period_s = 0.001\n[drive.dac]\n"
     "resolution_V = 0.00030517578125\nlimit_V = 10.0\n[drive.encoder]\nresolution_m = 5e-7\n",
     "[[effect]]\nkind = \"inertia\"\nM_kg = 40.0\n[[effect]]\nkind = \"viscous\"\nB_N_s_per_m = 90.0\n"
     "[[effect]]\nkind = \"coulomb\"\npositive_N = 24.0\nnegative_N = -18.0\n",
     "travel=0.1m,speed=200mm/s,volts=4,time=6", "M_kg", 40.0, 24.0, -18.0},
};

class Excite : public testing::TestWithParam<Drive> {
 protected:
  std::string file(const char* name) const { return folder_.path(name); }
  std::string model() const {
    std::ofstream(file("plant.toml")) << "format = \"axis-model/1\"\nname = \"x\"\n[drive]\n"
                                      << GetParam().data_sheet << GetParam().effects;
    return file("plant.toml");
  }
  std::string data_sheet() const {
    std::ofstream(file("drive.toml")) << "format = \"axis-model/1\"\nname = \"x\"\n[drive]\n" << GetParam().data_sheet;
    return file("drive.toml");
  }
  ProgramRun excite(const std::string& words, const std::string& streams = "2>&1") const {
    return run_axistool("excite " + words + " --device model:" + model() + " --countdown 0 -o " + file("r.csv"),
                        streams);
  }
  TemporaryFolder folder_;
};

std::string name_of(const testing::TestParamInfo<Drive>& info) { return "Drive" + std::to_string(info.index); }
INSTANTIATE_TEST_SUITE_P(Drives, Excite, testing::ValuesIn(kDrives), name_of);

/// The first record of a drive, made without a controller, is sufficient to identify it.
TEST_P(Excite, StepsOnAnEmptyBoardIdentifyTheDrive) {
  const ProgramRun made =
      excite(std::string("x steps --yes --json - --box ") + GetParam().box + " --drive " + data_sheet(), "2>/dev/null");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const auto told = nlohmann::json::parse(made.output);
  EXPECT_EQ(told["ended"], "completed");
  EXPECT_EQ(told["lost_rows"], 0);
  EXPECT_GE(told["rows"], 6000);
  EXPECT_EQ(host::read_record(file("r.csv")).header.at("excitation"), "steps");
  const ProgramRun identified =
      run_axistool("identify " + file("r.csv") + " --drive " + data_sheet() + " -o " + file("found.toml") + " --json -",
                   "2>/dev/null");
  ASSERT_EQ(identified.exit_code, 0) << identified.output;
  EXPECT_EQ(run_axistool("identify " + file("r.csv") + " --drive " + data_sheet() + " --window 1").exit_code, 2);
  const auto found = nlohmann::json::parse(identified.output)["parameters"];
  const bool is_linear = std::string(GetParam().inertia) == "M_kg";
  EXPECT_NEAR(found[GetParam().inertia]["value"].get<double>() / GetParam().J, 1.0, 0.02);
  EXPECT_NEAR(found[is_linear ? "positive_N" : "positive_Nm"]["value"].get<double>() / GetParam().positive, 1.0, 0.05);
  EXPECT_NEAR(found[is_linear ? "negative_N" : "negative_Nm"]["value"].get<double>() / GetParam().negative, 1.0, 0.05);
}

class ExciteRefuses : public Excite {};
INSTANTIATE_TEST_SUITE_P(OneDrive, ExciteRefuses, testing::Values(kDrives[0]), name_of);

TEST_P(ExciteRefuses, WithoutABoxOrUnitsOrConsent) {
  EXPECT_EQ(excite("x steps --yes").exit_code, 8);
  const ProgramRun lacks = excite("x steps --yes --box travel=10,speed=100,volts=3");
  EXPECT_EQ(lacks.exit_code, 8);
  EXPECT_THAT(lacks.output, HasSubstr("the box has no time"));
  const ProgramRun unknown = excite("x steps --yes --box travel=10,speed=100,volts=3,time=1");
  EXPECT_EQ(unknown.exit_code, 8);
  EXPECT_THAT(unknown.output, HasSubstr("--drive"));
  const std::string whole = " --box travel=10,speed=100,volts=3,time=1 --drive " + data_sheet();
  EXPECT_EQ(excite("x steps" + whole).exit_code, 8) << "nobody said yes";
  EXPECT_EQ(excite("x staps --yes" + whole).exit_code, 2);
  EXPECT_EQ(excite("x steps 4 -4 --yes" + whole).exit_code, 8) << "more volts than the box has";
  EXPECT_EQ(excite("x ladder --yes" + whole).exit_code, 8) << "a closed loop without a controller";
}

/// A box that the drive must leave: excite reports this, stops, and keeps the record so far.
TEST_P(ExciteRefuses, ToGoOnOutsideTheBox) {
  const ProgramRun left =
      excite("x sine amplitude=6 frequency=0.5 --yes --box travel=4,speed=400,volts=6,time=3 --drive " + data_sheet());
  EXPECT_EQ(left.exit_code, 8);
  EXPECT_THAT(left.output, HasSubstr("left the box: travel"));
  const host::Record record = host::read_record(file("r.csv"));
  EXPECT_GT(*std::ranges::max_element(record.x), 2.0);
  EXPECT_LT(*std::ranges::max_element(record.x), 4.0) << "2 mm to the edge, plus the stopping distance";
  EXPECT_LT(std::abs(record.x.back() - record.x[record.size() - 20]), 0.002) << "it stands at the end";
}

#define COGGING_SHEET                                                                                             \
  "kind = \"rotary\"\namplifier_gain_A_per_V = 6.5\ntorque_constant_Nm_per_A = 0.48\nlead_mm_per_rad = 1.59155\n" \
  "sample_period_s = 0.001\n[drive.dac]\nresolution_V = 0.00030517578125\nlimit_V = 10.0\n[drive.encoder]\n"      \
  "resolution_mm = 0.001\n"
constexpr const char* kCogging =
    "[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = 0.0081\n[[effect]]\nkind = \"coulomb\"\npositive_Nm = 2.1\n"
    "negative_Nm = -1.8\n[[effect]]\nkind = \"cogging\"\ncosine_Nm = 1.5\nsine_Nm = 0.0\nperiod_mm = 4.0\n";
const Drive kCoggingDrives[] = {
    {"with a tachometer", COGGING_SHEET "[drive.tach]\nnoise_variance_rad2_s2 = 0.05\n", kCogging, "", "", 0, 0, 0},
    {"encoder alone", COGGING_SHEET, kCogging, "", "", 0, 0, 0},
};
class ExciteACoggingAxis : public Excite {};
INSTANTIATE_TEST_SUITE_P(Drives, ExciteACoggingAxis, testing::ValuesIn(kCoggingDrives), name_of);

/// Friction and cogging hold the axis up to 1.2 V in one place and up to 0.2 V in another. Catches a standstill in a
/// cogging position that is treated as a jam.
TEST_P(ExciteACoggingAxis, GoesOnWhereItHangs) {
  for (const char* words : {"x ramp", "x sine", "x chirp", "x steps"}) {
    const ProgramRun done =
        excite(std::string(words) + " --yes --box travel=40,speed=150,volts=2,time=5 --drive " + data_sheet());
    EXPECT_EQ(done.exit_code, 0) << words << ": " << done.output;
  }
  const ProgramRun weak = excite("x steps --yes --box travel=40,speed=150,volts=0.15,time=5 --drive " + data_sheet());
  EXPECT_EQ(weak.exit_code, 8);
  EXPECT_THAT(weak.output, HasSubstr("nothing moved")) << "an axis that never moves is reported";
}

}  // namespace
