// The files that axistool open writes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

/// A log in counts, whose size follows from the set point: the data sheet contains the values from the log and the
/// given constant.
TEST(OpenCommand, LeavesADataSheetThatTheLogHasFilledIn) {
  const TemporaryFolder folder;
  std::string text = "t [s],Iq [A],Pos [inc],Set [mm]\n";
  for (int k = 0; k < 3000; ++k) {
    const double x = 20.0 * std::sin(0.002 * k) + 3.0 * std::sin(0.013 * k);
    const double v = 0.04 * std::cos(0.002 * k) + 0.039 * std::cos(0.013 * k);
    text += fmt::format("{:.3f},{:.4f},{:.0f},{:.5f}\n", 1e-3 * k, 20.0 * v + (v > 0.0 ? 0.5 : -0.5), x / 0.00125, x);
  }
  const std::string log = folder.write("log.csv", text), out = folder.path("x");
  ASSERT_EQ(run_axistool(fmt::format("open {} --yes -o {}", log, out)).exit_code, 0);
  const ProgramRun sheet = run_program(fmt::format("cat {}/sheet.toml", out));
  EXPECT_NE(sheet.output.find("# torque_constant_Nm_per_A ="), std::string::npos) << sheet.output;
  EXPECT_NE(sheet.output.find("resolution_mm = 0.00125"), std::string::npos) << sheet.output;
  EXPECT_NE(sheet.output.find("sample_period_s = 0.001"), std::string::npos) << sheet.output;
  // The next log does not overwrite values that were filled in by hand.
  folder.write("x/sheet.toml", "filled in");
  ASSERT_EQ(run_axistool(fmt::format("open {} --yes -o {}", log, out)).exit_code, 0);
  EXPECT_EQ(run_program(fmt::format("cat {}/sheet.toml", out)).output, "filled in");
}

}  // namespace
