// axistool bode on a simulated board, and on the records that it writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;

class Bode : public testing::Test {
 protected:
  Bode() {
    const std::string model = std::string(AXIS_TEST_DATA) + "/drive-cases/none/case-00/model.toml";
    std::filesystem::copy_file(model, file("model.toml"));
    std::ofstream(file("plant.toml")) << host::read_file(model)
                                      << "\n[[effect]]\nkind = \"compliance\"\nresonance_Hz = 110.0\n"
                                         "damping_ratio = 0.04\nload_fraction = 0.3\n";
    run_axistool("design " + file("model.toml") + " -o " + file("params.toml"));
  }
  std::string file(const std::string& name) const { return folder_.path(name); }
  ProgramRun bode(const std::string& words) const {
    return run_axistool(
        "bode x --device model:" + file("plant.toml") + " --params " + file("params.toml") + " --countdown 0 " + words,
        "2>&1");
  }
  TemporaryFolder folder_;
};

TEST_F(Bode, MeasuresAnAxisAndItsRecordsSayTheSame) {
  const ProgramRun measured = bode("--yes --box travel=60,speed=100,volts=4,time=80 --json " + file("axis.json") +
                                   " --report " + file("axis.html") + " -o " + file("runs"));
  ASSERT_EQ(measured.exit_code, 0) << measured.output;
  EXPECT_THAT(measured.output, HasSubstr("Modulus margin"));
  const json axis = json::parse(host::read_file(file("axis.json")));
  EXPECT_EQ(axis["format"], "axis-response/1");
  ASSERT_EQ(axis["resonances"].size(), 1u);
  EXPECT_NEAR(axis["resonances"][0]["f_Hz"].get<double>(), 110.0, 1.1);
  for (const char* curve : {"noise", "nonlinearity"}) EXPECT_EQ(axis[curve].size(), axis["f_Hz"].size());
  for (const char* curve : {"plant", "open_loop"})
    for (const char* part : {"re", "im", "sd"}) EXPECT_EQ(axis[curve][part].size(), axis["f_Hz"].size());
  for (const char* margin : {"phase_deg", "modulus", "crossover_Hz"}) {
    EXPECT_GT(axis["margins"][margin]["value"], axis["margins"][margin]["ci95"][0]);
    EXPECT_LT(axis["margins"][margin]["value"], axis["margins"][margin]["ci95"][1]);
  }
  EXPECT_THAT(host::read_file(file("axis.html")), HasSubstr("Nyquist plot"));

  std::string records;
  for (const auto& entry : std::filesystem::directory_iterator(file("runs"))) records += entry.path().string() + " ";
  const ProgramRun again =
      run_axistool("bode " + records + " --model " + file("model.toml") + " --json -", "2>/dev/null");
  ASSERT_EQ(again.exit_code, 0) << again.output;
  const json read = json::parse(again.output);
  EXPECT_EQ(read["f_Hz"].size(), axis["f_Hz"].size());
  EXPECT_NEAR(read["margins"]["modulus"]["value"].get<double>(), axis["margins"]["modulus"]["value"].get<double>(),
              0.01);
}

TEST_F(Bode, MovesNothingWithoutABoxOrConsent) {
  EXPECT_EQ(bode("--yes").exit_code, 8);
  EXPECT_EQ(bode("--box travel=60,speed=100,volts=4,time=80").exit_code, 8);
  const ProgramRun tried = bode("--box travel=60,speed=100,volts=4,time=80 --dry-run");
  EXPECT_EQ(tried.exit_code, 0);
  EXPECT_THAT(tried.output, HasSubstr("odd lines"));
  EXPECT_EQ(bode("--yes --box travel=60,speed=100,volts=4,time=4").exit_code, 8) << "too short for anything";
}

}  // namespace
