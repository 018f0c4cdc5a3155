// A change without effect on the physics must not change the diagnosis, on a record simulated by another program.
#include "host/scoreboard/rewriting.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/host/skip_where_instrumented.hpp"

namespace {

// All in one test, because the original is diagnosed only once. The last change affects the physics: the command has
// another scale than the data sheet, which the parameters must show.
TEST(Rewritten, ACaseGetsTheSameAnswerUnlessThePhysicsChanges) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::Question question =
      host::read_question(host::whole_case(AXIS_TEST_DATA "/drive-cases/single/case-13", "case-13"));
  std::vector<host::Rewriting> chosen(host::rewritings().begin(), host::rewritings().end());
  chosen.push_back({"command x 0.7", [](host::Question& changed) {
                      for (host::Record& record : changed.train)
                        for (double& u_V : record.u_V) u_V *= 0.7;
                      for (host::Record& record : changed.validate)
                        for (double& u_V : record.u_V) u_V *= 0.7;
                    }});
  const auto results = host::try_rewritings(question, chosen);
  ASSERT_EQ(results.size(), chosen.size());
  for (std::size_t k = 0; k + 1 < chosen.size(); ++k) {
    SCOPED_TRACE(chosen[k].name);
    EXPECT_TRUE(results[k].same_verdict) << results[k].original << " -> " << results[k].rewritten;
    EXPECT_EQ(results[k].original, "missing tach_gain");
    EXPECT_LE(results[k].worst_parameter, 1.0);
    EXPECT_LE(results[k].error_ratio, 1.1);
  }
  EXPECT_GT(results.back().worst_parameter, 1.0);
}

}  // namespace
