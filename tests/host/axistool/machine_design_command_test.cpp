// axistool design with a model of each axis.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;

class MachineDesignCommand : public testing::Test {
 protected:
  MachineDesignCommand() {
    std::string model = host::read_file(std::string(AXIS_TEST_DATA) + "/drive-cases/none/case-00/model.toml");
    const auto set = [&](const std::string& key, const std::string& value) {
      const std::size_t at = model.find("\n" + key + " = ") + 1;
      model.replace(at, model.find('\n', at) - at, key + " = " + value);
    };
    set("name", "\"x\"");
    folder_.write("x.toml", model);
    model += "\n[[effect]]\nkind = \"input_delay\"\ndelay_s = 0.0008\n";
    set("name", "\"y\"");
    set("J_kg_m2", "0.0153");
    folder_.write("y.toml", model);
  }
  std::string file(const std::string& name) const { return folder_.path(name); }
  ProgramRun design(const std::string& words, const std::string& streams = "2>&1") const {
    return run_axistool("design " + file("x.toml") + " " + file("y.toml") + " " + words, streams);
  }
  TemporaryFolder folder_;
};

TEST_F(MachineDesignCommand, WritesAFileOfEachAxisWhetherTheFolderExistsOrNot) {
  std::filesystem::create_directory(file("there"));
  for (const char* folder : {"there", "new", "deep/new"}) {
    const ProgramRun run = design("--margin 0.4 -o " + file(folder));
    ASSERT_EQ(run.exit_code, 0) << run.output;
    for (const char* axis : {"x", "y"})
      EXPECT_THAT(host::read_file(file(std::string(folder) + "/" + axis + "-params.toml")),
                  HasSubstr("[" + std::string(axis) + ".kalman]"));
    EXPECT_THAT(run.output, HasSubstr("line, matched"));
  }
}

TEST_F(MachineDesignCommand, SaysByFeedWhatIsLeftAndWhatTheOwnLoopsCost) {
  const ProgramRun run = design("--margin 0.4 --feedforward velocity --json -", "2>/dev/null");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json found = json::parse(run.output);
  EXPECT_EQ(found["format"], "axis-machine-design/1");
  EXPECT_EQ(found["written"], "matched");
  ASSERT_EQ(found["matched"]["axes"].size(), 2u);
  EXPECT_EQ(found["matched"]["axes"][0]["options"]["fc_Hz"], found["matched"]["axes"][1]["options"]["fc_Hz"]);
  EXPECT_FALSE(found["matched"]["axes"][0]["options"]["zero_phase"]);
  for (const char* set : {"matched", "own"})
    for (const json& one : found[set]["contour"]) {
      EXPECT_GE(one["line_45_um"], 0.0);
      EXPECT_GE(one["ellipse_um"], 0.0);
    }
  EXPECT_THAT(found["limited_by"].get<std::string>(), HasSubstr("modulus margin of 0.4"));
}

TEST_F(MachineDesignCommand, OwnWritesTheBestOfEachAxis) {
  const ProgramRun run = design("--margin 0.4 --own --json - -o " + file("own"), "2>/dev/null");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json found = json::parse(run.output);
  EXPECT_EQ(found["written"], "own");
  const double k1 = found["own"]["axes"][0]["Kc"][0];
  const std::string text = host::read_file(file("own/x-params.toml"));
  EXPECT_NEAR(std::stod(text.substr(text.find("k1 = ", text.find("[x.feedback]")) + 5)), k1, 1e-6 * k1);
}

TEST_F(MachineDesignCommand, RefusesWhatDoesNotGoTogether) {
  EXPECT_EQ(design("-o " + file("x.toml")).exit_code, 9) << "a file stands where the folder should be";
  EXPECT_EQ(design("--response " + file("x.toml")).exit_code, 2) << "one response for two axes";
  EXPECT_EQ(design("--report " + file("page.html")).exit_code, 2);
  EXPECT_EQ(run_axistool("design " + file("x.toml") + " " + file("x.toml")).exit_code, 2) << "one name twice";
  EXPECT_EQ(run_axistool("design " + file("x.toml") + " --own").exit_code, 2);
  EXPECT_EQ(design("--feedforward none").exit_code, 2);
  std::filesystem::create_directory(file("folder"));
  EXPECT_EQ(run_axistool("design " + file("x.toml") + " -o " + file("folder")).exit_code, 2) << "one model, one file";
}

}  // namespace
