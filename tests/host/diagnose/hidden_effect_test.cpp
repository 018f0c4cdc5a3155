// The hidden-effect test: from records of an independent plant with a hidden effect, the diagnosis must find exactly
// that effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/diagnose/found_effect.hpp"
#include "sim/catalogue.hpp"
#include "tests/host/diagnose/drive_case.hpp"

namespace {

using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

/// Least share of the squares in an effect's figure that the fitted effect explains; 0.88 to 1.00 on the drive cases.
constexpr double kLeastExplained = 0.8;

class HiddenEffect : public testing::TestWithParam<std::string> {};

TEST_P(HiddenEffect, IsFoundAndNothingElse) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase hidden(GetParam());
  const host::Diagnosis diagnosis = hidden.diagnose();
  const host::DiagnosisVerdict& verdict = diagnosis.verdict;
  SCOPED_TRACE(verdict.explanation);
  if (hidden.effects.empty()) {
    EXPECT_TRUE(verdict.status == host::Status::adequate || verdict.status == host::Status::parameters)
        << host::status_name(verdict.status);
    EXPECT_THAT(verdict.effects, IsEmpty());
    return;
  }
  const auto is_known_group = [&](const std::vector<std::string>& named) {
    return std::ranges::any_of(hidden.groups,
                               [&](const auto& group) { return std::ranges::is_permutation(group, named); });
  };
  if (verdict.status == host::Status::ambiguous && is_known_group(verdict.effects)) {
    for (const std::string& effect : hidden.effects) EXPECT_THAT(verdict.effects, testing::Contains(effect));
  } else {
    EXPECT_EQ(verdict.status, host::Status::missing) << host::status_name(verdict.status);
    EXPECT_THAT(verdict.effects, UnorderedElementsAreArray(hidden.effects));
  }
  EXPECT_LT(diagnosis.after_validate, diagnosis.before_validate);

  // Catches a figure in which the effect does not show: another view than the catalogue states, seconds without the
  // effect, or a part that is not the residual's.
  for (const host::FoundEffect& effect : host::found_effects(diagnosis.best, verdict.effects, diagnosis)) {
    EXPECT_EQ(effect.view, sim::find_effect(effect.kind)->view) << effect.kind;
    EXPECT_GT(host::explained_share(effect), kLeastExplained) << effect.kind;
  }
}

/// A found effect must have the size of the hidden one, in the unit of the machine, over the coordinate in which it
/// shows.
TEST(FoundEffect, HasTheSizeThatWasHidden) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double kHidden_Nm = 0.156, kPeriod_mm = 1.25;  // cog1 and cog1_per in its truth.json
  DriveCase cogging("single/case-00");
  const host::Diagnosis diagnosis = cogging.diagnose();
  const auto found = host::found_effects(diagnosis.best, {"cogging", "backlash"}, diagnosis);
  ASSERT_EQ(found.size(), 1U) << "what the model does not hold is absent";
  EXPECT_NEAR(found[0].size, kHidden_Nm, 0.1 * kHidden_Nm);
  ASSERT_TRUE(found[0].ci95 && found[0].share_of_friction);
  EXPECT_LT((*found[0].ci95)[0], kHidden_Nm);
  EXPECT_GT((*found[0].ci95)[1], kHidden_Nm);
  EXPECT_NEAR(*found[0].share_of_friction, kHidden_Nm / 2.08, 0.02) << "mean of the two Coulomb levels";
  EXPECT_TRUE(found[0].over.folded);
  EXPECT_NEAR(found[0].over.period, kPeriod_mm, 0.01);
  const host::ScatterPlot plot = host::effect_plot(found[0]);
  ASSERT_EQ(plot.series.size(), 4U) << "residual and effect, forward and backward";
  EXPECT_EQ(plot.x.unit, "mm");
}

INSTANTIATE_TEST_SUITE_P(DriveCases, HiddenEffect,
                         testing::Values("none/case-00", "none/case-01", "single/case-00", "single/case-06",
                                         "single/case-09", "single/case-13", "single/case-17", "single/case-19",
                                         "pairs/case-00"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::ranges::replace_if(
                               name, [](char letter) { return letter == '/' || letter == '-'; }, '_');
                           return name;
                         });

}  // namespace
