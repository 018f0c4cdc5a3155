// Complete commissionings, over the board's protocol, of machines with physics independent of the simulator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "host/report/text_format.hpp"
#include "tests/host/commission/own_machine.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;

struct Outcome {
  json state, errors;
  std::string page;
  std::vector<double> prediction_errors;  ///< before and after, as the steps compare and improve state them
  double before() const { return errors["sets"].front()["rms_um"]; }
  double after() const { return kept()["rms_um"]; }
  const json& kept() const {
    return *std::ranges::find_if(errors["sets"], [&](const json& set) { return set["name"] == errors["kept"]; });
  }
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
  // The steps state the same figures for the initial model as the commands.
  const json diagnosed = read(folder.path("x/diagnosis.json"));
  EXPECT_EQ(read(folder.path("x/comparison.json"))["error"], diagnosed["error"]["given"]["validate"]);
  Outcome outcome;
  outcome.state = read(folder.path("x/commission.json"));
  outcome.errors = read(folder.path("x/errors.json"));
  std::ifstream page(folder.path("x/page.html"));
  outcome.page.assign(std::istreambuf_iterator<char>(page), {});
  const json compared = read(folder.path("x/comparison.json")), improved = read(folder.path("x/improvement.json"));
  outcome.prediction_errors = {compared["combined"], improved["error"]["after"]["validate"]["combined"]};
  return outcome;
}

/// The sentences of the page, without markup and scripts.
std::vector<std::string> sentences_of(std::string page) {
  page = std::regex_replace(page.substr(0, page.find("<script")), std::regex("<style[^]*?</style>|<[^>]*>"), ". ");
  std::vector<std::string> sentences;
  const std::regex end("[.:;]\\s+");
  for (std::sregex_token_iterator one(page.begin(), page.end(), end, -1), none; one != none; ++one)
    if (std::ranges::count(one->str(), ' ') >= 3) sentences.push_back(one->str());
  return sentences;
}

/// Catches a set of parameters that stays although every run with another is better by more than equal runs differ.
void expect_none_better(const Outcome& found) {
  const double kept_um = found.after(), kept_spread_um = found.kept()["repeats_um"];
  for (const json& set : found.errors["sets"]) {
    std::printf("%s: %s +- %s um%s\n", set["what"].get<std::string>().c_str(), set["rms_um"].dump().c_str(),
                set["repeats_um"].dump().c_str(), set == found.kept() ? ", kept" : "");
    if (set["rms_um"].is_null()) continue;
    const double spread_um = set["repeats_um"];
    EXPECT_LE(kept_um - kept_spread_um / 2.0 - set["rms_um"].get<double>() - spread_um / 2.0,
              std::max(kept_spread_um, spread_um))
        << set["what"];
  }
}

std::vector<std::string> names(const Outcome& found) {
  std::vector<std::string> names;
  for (const json& set : found.errors["sets"]) names.push_back(set["name"]);
  return names;
}

/// Catches positions that are not counted from home, which makes the compensation ineffective, and a loop with more
/// bandwidth than the machine allows.
TEST(CommissionedMachine, IsFoundToCogAndFollowsBetterFromItsHome) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  OwnBoard board;
  board.machine->cogging_Nm = 0.4;
  const Outcome found = commissioned(board, own_options());
  EXPECT_THAT(found.effects(), testing::ElementsAre("cogging"));
  EXPECT_EQ(found.state["kept"], "new");
  EXPECT_LT(found.after(), 0.8 * found.before());
  EXPECT_THAT(names(found), testing::IsSupersetOf({"before", "loop", "untuned", "after"}));
  expect_none_better(found);
  EXPECT_TRUE(found.state["raised"].is_object());
  EXPECT_GT(found.state["raised"]["margins"]["measured"]["modulus"]["value"].get<double>(), 0.45);
  EXPECT_LT(found.state["motion_s"].get<double>(), 360.0);
  EXPECT_THAT(found.page, testing::HasSubstr("used as Rw"));
  // Each quantity has one figure on the page, and no sentence occurs twice.
  std::vector<std::string> sentences = sentences_of(found.page);
  for (const double error : found.prediction_errors)
    EXPECT_THAT(sentences, testing::Contains(testing::AllOf(testing::HasSubstr("prediction error falls"),
                                                            testing::HasSubstr(host::format_value(error)))));
  std::ranges::sort(sentences);
  const auto twice = std::ranges::adjacent_find(sentences);
  EXPECT_EQ(twice, sentences.end()) << (twice == sentences.end() ? "" : *twice);
}

/// Catches effects that are found although there are none, and an estimator that stays although it gains nothing.
TEST(CommissionedMachine, IsNamedNothingWhereNothingIsHidden) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  OwnBoard board;
  const Outcome found = commissioned(board, own_options());
  EXPECT_THAT(found.state["verdict"]["status"].get<std::string>(), testing::AnyOf("adequate", "parameters"));
  EXPECT_THAT(found.effects(), testing::IsEmpty());
  EXPECT_THAT(names(found), testing::IsSupersetOf({"before", "loop", "untuned", "after"}));
  expect_none_better(found);
  const bool is_tuned = found.errors["kept"] == "loop" || found.errors["kept"] == "after";
  EXPECT_EQ(found.state["estimator_kept"], is_tuned);
}

/// Catches a weight that is identified as friction, and a position-dependent compensation that is offered without
/// homing.
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
