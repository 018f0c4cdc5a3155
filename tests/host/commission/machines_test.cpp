// Whole commissionings, through the board's protocol, of machines whose physics share no code with the simulator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/host/commission/own_machine.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;

struct Outcome {
  json state, errors;
  double before() const { return errors["sets"].front()["rms_um"]; }
  double after() const { return errors["sets"].back()["rms_um"]; }
  std::vector<std::string> effects() const { return state["verdict"]["effects"]; }
};

json read(const std::string& path) {
  std::ifstream file(path);
  return json::parse(file);
}

Outcome commissioned(OwnBoard& board, const host::CommissionOptions& options) {
  const TemporaryFolder folder;
  const auto [code, words] = commission(board, folder.path("x"), "look", "page", {}, options);
  EXPECT_EQ(code, host::ExitCode::done) << words;
  if (code != host::ExitCode::done) return {};
  // Its steps, like its commands, have one set of figures for the model that they begin with.
  const json diagnosed = read(folder.path("x/diagnosis.json"));
  EXPECT_EQ(read(folder.path("x/comparison.json"))["error"], diagnosed["error"]["given"]["validate"]);
  return {read(folder.path("x/commission.json")), read(folder.path("x/errors.json"))};
}

/// Catches positions that are not counted from home (then the compensation has another phase, or does not act), and
/// a loop that is made livelier than the machine bears.
TEST(CommissionedMachine, IsFoundToCogAndFollowsBetterFromItsHome) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  OwnBoard board;
  board.machine->cogging_Nm = 0.4;
  const Outcome found = commissioned(board, own_options());
  EXPECT_THAT(found.effects(), testing::ElementsAre("cogging"));
  EXPECT_EQ(found.state["kept"], "new");
  EXPECT_LT(found.after(), 0.8 * found.before());
  EXPECT_TRUE(found.state["raised"].is_object());
  EXPECT_GT(found.state["raised"]["margins"]["measured"]["modulus"]["value"].get<double>(), 0.45);
  EXPECT_LT(found.state["motion_s"].get<double>(), 360.0);
}

/// Catches effects that are named where none is.
TEST(CommissionedMachine, IsNamedNothingWhereNothingIsHidden) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  OwnBoard board;
  const Outcome found = commissioned(board, own_options());
  EXPECT_THAT(found.state["verdict"]["status"].get<std::string>(), testing::AnyOf("adequate", "parameters"));
  EXPECT_THAT(found.effects(), testing::IsEmpty());
}

/// Catches a weight that is taken for friction, and a place-bound compensation that is promised without a home.
TEST(CommissionedMachine, IsToldThatItCarriesAWeight) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  OwnBoard board(hal::pc::AxisWiring{});
  board.machine->weight_Nm = 0.8;
  host::CommissionOptions options = own_options();
  options.homing.reset();
  options.sheet.effects.push_back({"coulomb", {{"level", 1.8}}, {}, {}});
  const Outcome found = commissioned(board, options);
  EXPECT_THAT(found.effects(), testing::Contains("constant_torque"));
  EXPECT_THAT(found.errors["needs_home"], testing::IsEmpty());
}

}  // namespace
