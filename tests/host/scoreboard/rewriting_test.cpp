// What does not change the physics must not change the diagnosis, on the record of a drive that another program made.
#include "host/scoreboard/rewriting.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/host/skip_where_instrumented.hpp"

namespace {

class Rewritten : public testing::TestWithParam<host::Rewriting> {};

TEST_P(Rewritten, ACaseGetsTheSameAnswer) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::Question question =
      host::read_question(host::whole_case(AXIS_TEST_DATA "/drive-cases/single/case-13", "case-13"));
  const host::Rewriting& rewriting = GetParam();
  const auto results = host::try_rewritings(question, {&rewriting, 1});
  EXPECT_TRUE(results[0].same_verdict) << results[0].original << " -> " << results[0].rewritten;
  EXPECT_EQ(results[0].original, "missing tach_gain");
  EXPECT_LE(results[0].worst_parameter, 1.0);
  EXPECT_LE(results[0].error_ratio, 1.1);
}

std::string name_of(const testing::TestParamInfo<host::Rewriting>& rewriting) {
  std::string name(rewriting.param.name);
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Every, Rewritten, testing::ValuesIn(host::rewritings().begin(), host::rewritings().end()),
                         name_of);

// What the rewriting of a volt would not be: the physics itself is another.
TEST(Rewriting, ACommandInAnotherVoltThanTheDataSheetsIsNoRewriting) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::Question question =
      host::read_question(host::whole_case(AXIS_TEST_DATA "/drive-cases/single/case-13", "case-13"));
  const host::Rewriting half{"command x 0.7", [](host::Question& changed) {
                               for (host::Record& record : changed.train)
                                 for (double& u_V : record.u_V) u_V *= 0.7;
                               for (host::Record& record : changed.validate)
                                 for (double& u_V : record.u_V) u_V *= 0.7;
                             }};
  const auto results = host::try_rewritings(question, {&half, 1});
  EXPECT_GT(results[0].worst_parameter, 1.0);
}

}  // namespace
