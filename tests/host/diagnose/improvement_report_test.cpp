// The report of an improvement: figures, file and the next command, instead of a missing effect.
#include "host/diagnose/improvement_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/diagnose/diagnosis_figures.hpp"

namespace host {
namespace {

using testing::HasSubstr;

Improvement by_adding(const std::vector<std::string>& kinds, double left) {
  Improvement improvement;
  improvement.first.given_error.train.combined = 10.0;
  improvement.first.given_error.validate.combined = 18.6;
  improvement.ladder.push_back({{}, 9.0, 17.0, {}});
  if (!kinds.empty()) improvement.ladder.push_back({kinds, left, left, {}});
  improvement.error.validate.combined = kinds.empty() ? 17.0 : left;
  improvement.stopped_because = "nothing is left";
  improvement.verdict.status = Status::adequate;
  return improvement;
}

TEST(ImprovementVerdict, TellsTheFallAndWhatWasAdded) {
  const Verdict verdict = improvement_verdict(by_adding({"cogging"}, 0.78), {"x.toml", "out dir/x2.toml"});
  EXPECT_EQ(verdict.headline, "18.6 → 0.780 × noise floor by adding cogging");
  EXPECT_EQ(verdict.tone, Tone::good);
  EXPECT_EQ(verdict.command, "axistool design 'out dir/x2.toml' -o 'out dir/x2-params.toml'");
  EXPECT_THAT(verdict.sentences, testing::Contains(HasSubstr("out dir/x2.toml")));
}

TEST(ImprovementVerdict, WhatStaysFarAboveTheFloorIsNotCalledGood) {
  Improvement improvement = by_adding({"cogging"}, 5.0);
  improvement.verdict.status = Status::unexplained;
  EXPECT_EQ(improvement_verdict(improvement, {"x.toml", "y.toml"}).tone, Tone::attention);
}

TEST(ImprovementVerdict, NothingAddedIsSaid) {
  EXPECT_THAT(improvement_verdict(by_adding({}, 0.0), {"x.toml", "y.toml"}).headline,
              HasSubstr("Nothing had to be added"));
  Improvement unexplained = by_adding({}, 0.0);
  unexplained.verdict.status = Status::unexplained;
  EXPECT_EQ(improvement_verdict(unexplained, {"x.toml", "y.toml"}).tone, Tone::bad);
}

TEST(LadderChart, BeginsWithTheModelAsGiven) {
  const BarChart chart = ladder_chart(by_adding({"cogging"}, 0.78));
  ASSERT_EQ(chart.rows.size(), 3u);
  EXPECT_EQ(chart.rows[0].label, "as given");
  EXPECT_EQ(chart.rows[0].values, (std::vector<double>{10.0, 18.6}));
}

JudgedCandidate candidate(const std::string& kind, double after) {
  JudgedCandidate judged;
  judged.kinds = {kind};
  judged.before = 10.0;
  judged.after = judged.train_after = after;
  return judged;
}

// Catches pairs of equal bars for effects that change nothing, and a rival that is not next to the effect from which it
// cannot be told apart.
TEST(Candidates, RivalsStandTogetherAndWhatChangesNothingIsFolded) {
  Diagnosis diagnosis;
  diagnosis.before_train = diagnosis.before_validate = 10.0;
  diagnosis.candidates = {candidate("cogging", 1.0), candidate("stribeck", 5.0), candidate("torque_ripple", 1.02),
                          candidate("backlash", 9.9), candidate("compliance", 9.8)};
  diagnosis.verdict.status = Status::ambiguous;
  diagnosis.verdict.effects = {"cogging", "torque_ripple"};
  diagnosis.verdict.alternatives = {{"cogging", "torque_ripple"}};
  Report report("test");
  add_candidates(report, diagnosis);
  const std::string html = report.html();
  const std::string page = html.substr(html.find("<div class=\"blocks\">"));
  std::size_t last = 0;
  for (const char* text : {"Cogging", "Torque ripple", "Stribeck", "<details>", "Backlash", "on a spring"}) {
    const std::size_t at = page.find(text, last);
    ASSERT_NE(at, std::string::npos) << text;
    last = at;
  }
}

}  // namespace
}  // namespace host
