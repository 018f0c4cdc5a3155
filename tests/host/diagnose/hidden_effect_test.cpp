// The hidden-effect test: records of an independent plant in which something is hidden must lead to exactly that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/diagnose/drive_case.hpp"

namespace {

using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

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
