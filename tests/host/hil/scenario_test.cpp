// The shipped scenarios hold; a scenario is deterministic; errors name file, line, field and remedy.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/hil/scenario_report.hpp"
#include "host/hil/scenario_run.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<std::string> shipped() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(AXIS_TEST_DATA "/../../host/hil/scenarios"))
    paths.push_back(entry.path().string());
  std::ranges::sort(paths);
  return paths;
}

class ShippedScenario : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, ShippedScenario, testing::ValuesIn(shipped()), [](const auto& path) {
  std::string name = std::filesystem::path(path.param).stem().string();
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(ShippedScenario, Holds) {
  const host::Scenario scenario = host::read_scenario(GetParam());
#ifdef AXIS_INSTRUMENTED
  if (scenario.axes[0].knowledge == host::Knowledge::identified)
    GTEST_SKIP() << "identification takes too long with sanitizers";
#endif
  const host::ScenarioRun run = host::run_scenario(scenario);
  EXPECT_FALSE(run.expectations.empty()) << "it proves nothing";
  for (const auto& checked : run.expectations)
    EXPECT_TRUE(checked.holds || checked.aim) << checked.text << ": " << checked.found;
}

constexpr const char* kHead =
    "format = \"axis-scenario/1\"\nname = \"n\"\nseed = 4\nduration_s = 0.3\n[x]\ndrive = \"paper x\"\n[y]\ndrive = "
    "\"paper y\"\n";

host::Scenario parsed(const std::string& more) { return host::parse_scenario(kHead + more, "s.toml"); }

TEST(Scenario, IsTheSameEveryTimeAndAnotherWithAnotherSeed) {
  host::Scenario scenario = parsed("[[move]]\nat_s = 0\nkind = \"jog\"\naxis = \"x\"\nspeed_mm_s = 80\n");
  const auto once = host::run_scenario(scenario), twice = host::run_scenario(scenario);
  EXPECT_EQ(once.records[0].u_V, twice.records[0].u_V);
  EXPECT_EQ(once.records[0].w, twice.records[0].w);
  scenario.seed = 5;
  EXPECT_NE(host::run_scenario(scenario).records[0].w, once.records[0].w);
}

TEST(Scenario, AnAimThatIsMissedIsSaidButFailsNothing) {
  const auto run = host::run_scenario(parsed("[[expect]]\nsignal = \"position_mm\"\nat_least = 1\naim = true\n"));
  ASSERT_EQ(run.expectations.size(), 1u);
  EXPECT_FALSE(run.expectations[0].holds);
  EXPECT_TRUE(run.holds());
  EXPECT_TRUE(run.misses_aim());
  EXPECT_EQ(host::outcome_of(run).word, "misses its target");
}

TEST(Scenario, AnExpectationThatDoesNotHoldIsSaid) {
  const auto run =
      host::run_scenario(parsed("[[expect]]\naxis = \"y\"\nfault = \"overspeed\"\n"
                                "[[expect]]\nsignal = \"position_mm\"\nat_least = 1\n"
                                "[[expect]]\naxis = \"x\"\nstate = \"enabled\"\n"));
  ASSERT_EQ(run.expectations.size(), 3u);
  EXPECT_FALSE(run.expectations[0].holds);
  EXPECT_EQ(run.expectations[0].found, "no fault");
  EXPECT_FALSE(run.expectations[1].holds);
  EXPECT_TRUE(run.expectations[2].holds);
  EXPECT_FALSE(run.holds());
}

TEST(Scenario, AnAxisMayBeHeldAgainstTheOther) {
  const std::string moves =
      "[[move]]\nat_s = 0\nkind = \"jog\"\naxis = \"x\"\nspeed_mm_s = 20\n"
      "[[move]]\nat_s = 0\nkind = \"jog\"\naxis = \"y\"\nspeed_mm_s = 40\n";
  const auto expected = [](const char* axis, const char* other, double share) {
    return fmt::format("[[expect]]\naxis = \"{}\"\nsignal = \"speed_rad_s\"\nat_most_share = {}\nof_axis = \"{}\"\n",
                       axis, share, other);
  };
  const auto run =
      host::run_scenario(parsed(moves + expected("x", "y", 0.6) + expected("x", "y", 0.4) + expected("y", "x", 1.0)));
  ASSERT_EQ(run.expectations.size(), 3u);
  EXPECT_TRUE(run.expectations[0].holds) << run.expectations[0].found;
  EXPECT_FALSE(run.expectations[1].holds);
  EXPECT_FALSE(run.expectations[2].holds);
}

TEST(Scenario, AFaultInjectedAndHealedCanBeClearedAndTheAxisEnabledAgain) {
  host::Scenario scenario = parsed(
      "[[fault]]\nat_s = 0.05\nuntil_s = 0.06\nkind = \"emergency_stop\"\n"
      "[[move]]\nat_s = 0.1\nkind = \"clear\"\naxis = \"x\"\n"
      "[[move]]\nat_s = 0.2\nkind = \"enable\"\naxis = \"x\"\n"
      "[[expect]]\naxis = \"x\"\nstate = \"enabled\"\n[[expect]]\naxis = \"y\"\nstate = \"fault\"\n");
  const auto run = host::run_scenario(scenario);
  EXPECT_TRUE(run.holds());
}

std::string error_of(const std::string& text) {
  try {
    host::parse_scenario(text, "s.toml");
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    return failure.what();
  }
  return "accepted";
}
std::string error_with(const std::string& more) { return error_of(kHead + more); }

TEST(BadScenario, NamesFileLineFieldAndRemedy) {
  EXPECT_THAT(error_of("format = 3"), AllOf(HasSubstr("s.toml: line 1: format"), HasSubstr("in quotes")));
  EXPECT_THAT(error_of("format = \"axis-scenario/1\"\nname = \"n\"\n"), HasSubstr("add [x] with drive"));
  EXPECT_THAT(error_of("name ="), HasSubstr("line 1: not valid TOML"));
  EXPECT_THAT(error_with("[[move]]\nat_s = 0.1\nkind = \"jig\"\naxis = \"x\"\n"),
              AllOf(HasSubstr("line 11: kind in [[move]]"), HasSubstr("did you mean jog?")));
  EXPECT_THAT(error_with("[[move]]\nat_s = 9\nkind = \"stop\"\naxis = \"x\"\n"), HasSubstr("after the end"));
  EXPECT_THAT(error_with("[[move]]\nat_s = 0\nkind = \"jog\"\naxis = \"x\"\nspeed = 3\n"),
              HasSubstr("speed_mm_s in [[move]]: it is missing"));
  EXPECT_THAT(error_with("[[fault]]\nat_s = 0\nkind = \"emergency_stop\"\naxis = \"x\"\n"),
              HasSubstr("unknown field axis"));
  EXPECT_THAT(error_with("[[fault]]\nat_s = nan\nkind = \"blocked\"\naxis = \"x\"\n"), HasSubstr("finite number"));
  EXPECT_THAT(error_with("[[expect]]\naxis = \"x\"\n"), HasSubstr("nothing is expected"));
  EXPECT_THAT(error_with("[[expect]]\nsignal = \"contour_um\"\n"), HasSubstr("signal needs at_most"));
  EXPECT_THAT(error_with("[[expect]]\nsignal = \"table_um\"\nat_most_share = 0.5\n"), HasSubstr("of_axis"));
  EXPECT_THAT(error_with("[[x.effect]]\nkind = \"cogging\"\n"), HasSubstr("missing field"));
  EXPECT_THAT(error_of("format = \"axis-scenario/1\"\nname = \"n\"\n[x]\ndrive = \"nowhere.toml\"\n"),
              HasSubstr("there is no model file"));
}

TEST(ScenarioReport, ServesAnAxisWithoutATachometer) {
  host::Scenario scenario = parsed("");
  scenario.axes[0].drive.data.tach_noise_variance.reset();
  const auto run = host::run_scenario(scenario);
  ASSERT_FALSE(run.records[0].has_speed());
  EXPECT_THAT(scenario_report(scenario, run).html(), HasSubstr("Axis x: motion"));
}

TEST(ScenarioReport, ShowsFaultCauseAndPlots) {
  const host::Scenario scenario = parsed(
      "[[move]]\nat_s = 0.05\nkind = \"jog\"\naxis = \"x\"\nspeed_mm_s = 50\n[[fault]]\nat_s = 0.2\nkind = "
      "\"drive_fault\"\naxis = \"x\"\n[[expect]]\naxis = \"x\"\nfault = \"drive_fault\"\n");
  const auto run = host::run_scenario(scenario);
  const std::string html = scenario_report(scenario, run).html();
  EXPECT_THAT(html,
              AllOf(HasSubstr("the amplifier reports a fault"), HasSubstr("Tracking errors"), HasSubstr("holds")));
}

}  // namespace
