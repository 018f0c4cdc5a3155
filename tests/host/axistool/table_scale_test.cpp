// A scale on the table of the simulated board: from the board's counts to the effects found with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/record/read_record.hpp"
#include "tests/host/axistool/simulated_board.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kGap_mm = 0.04, kStep_mm = 0.0005;

class TableScale : public testing::Test {
 protected:
  /// The drive of the test case with additional TOML lines.
  std::string drive(const char* name, const std::string& lines) const {
    std::stringstream text;
    text << std::ifstream(kCase + "/model.toml").rdbuf() << lines;
    std::ofstream(folder_.path(name)) << text.str();
    return folder_.path(name);
  }

  TemporaryFolder folder_;
  const std::string scale_ = "\n[drive.load_encoder]\nresolution_mm = 0.0005\n";
  const std::string sheet_ = drive("sheet.toml", scale_);
  const std::string machine_ = drive("machine.toml", scale_ +
                                                         "\n[[effect]]\nkind = \"backlash\"\ngap_mm = 0.04\n"
                                                         "load_fraction = 0.3\nresonance_Hz = 300\n"
                                                         "damping_ratio = 0.1\nload_friction = 0.5\n");
};

/// Catches a wrong resolution of the scale, a reading at another time than the encoder's, and a scale that reads the
/// motor instead of the table.
TEST_F(TableScale, OfTheBoardMeasuresTheGap) {
  const SimulatedBoardProcess board(folder_.path(""), {"--x", machine_});
  const std::string params = folder_.path("params.toml"), record = folder_.path("table.csv");
  ASSERT_EQ(run_axistool("design " + kCase + "/model.toml -o " + params).exit_code, 0);
  ASSERT_EQ(board.run("set-params " + params + " host.timeout=5").exit_code, 0);
  const ProgramRun captured = board.run("capture x -o " + record + " --sheet " + sheet_ +
                                        " --jog 25:0.8,-25:0.8,10:1,-10:1,40:0.5,-40:0.5,5:1,-5:1 --yes");
  ASSERT_EQ(captured.exit_code, 0) << captured.output;
  const host::Record read = host::read_record(record);
  ASSERT_EQ(read.x2.size(), read.size());
  for (std::size_t k = 0; k < read.size(); k += 100) {
    EXPECT_NEAR(read.x2[k] / kStep_mm, std::round(read.x2[k] / kStep_mm), 1e-6);
    EXPECT_NEAR(read.x2[k], read.x[k], 2.0 * kGap_mm);
  }
  const ProgramRun compared = run_axistool("compare " + kCase + "/model.toml " + record + " --json -", "2>/dev/null");
  const nlohmann::json table = nlohmann::json::parse(compared.output, nullptr, false)["table"];
  const auto gap = std::ranges::find_if(
      table["found"], [](const nlohmann::json& found) { return found["kinds"] == nlohmann::json{"backlash"}; });
  ASSERT_NE(gap, table["found"].end()) << table.dump();
  EXPECT_NEAR((*gap)["sizes"]["gap"]["value"].get<double>(), 1e3 * kGap_mm, 2.0);

  const ProgramRun unknown_count = board.run("capture x -o " + record + " --channels u_V,x_mm,x2_mm");
  EXPECT_EQ(unknown_count.exit_code, 2);
  EXPECT_THAT(unknown_count.output, AllOf(HasSubstr("x2_mm"), HasSubstr("--sheet"), HasSubstr("[drive.load_encoder]")));
  EXPECT_EQ(board.run("capture x -o " + record + " --channels u_V,x2_mm --trigger x.now --sheet " + sheet_).exit_code,
            2)
      << "not in the board's own memory";

  const std::string steps = folder_.path("steps.csv");
  const ProgramRun excited = board.run("excite x steps --box travel=40,speed=150,volts=3,time=2 --drive " + sheet_ +
                                       " -o " + steps + " --yes");
  EXPECT_FALSE(host::read_record(steps).x2.empty()) << excited.output;
}

TEST_F(TableScale, IsRefusedByNameWhereTheAxisHasNone) {
  const SimulatedBoardProcess board(folder_.path(""), {"--x", kCase + "/model.toml"});
  const std::string record = folder_.path("idle.csv"),
                    capture = "capture x -o " + record + " --for 0.1 --sheet " + sheet_;
  const ProgramRun asked = board.run(capture + " --channels u_V,x_mm,x2_mm");
  EXPECT_EQ(asked.exit_code, 8);
  EXPECT_THAT(asked.output, AllOf(HasSubstr("no second encoder"), HasSubstr("x2_mm")));
  const ProgramRun usual = board.run(capture);
  EXPECT_EQ(usual.exit_code, 0);
  EXPECT_THAT(usual.output, HasSubstr("no second encoder")) << "a sheet that promises more than the board has";
  EXPECT_TRUE(host::read_record(record).x2.empty());
}

}  // namespace
