#include "host/report/text_format.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/report/binned_curve.hpp"
#include "host/report/packed_samples.hpp"

namespace host {
namespace {

TEST(TextFormat, EscapesEverythingThatHtmlReadsAsMarkup) {
  EXPECT_EQ(escape_html("<b a='1' c=\"2\">&amp;</b>"), "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt;&amp;amp;&lt;/b&gt;");
}

TEST(TextFormat, JsonInAScriptCannotEndTheScript) {
  const std::string text = script_safe_json({{"name", "</script><!--"}});
  EXPECT_EQ(text.find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text)["name"], "</script><!--") << "and still says the same";
}

TEST(TextFormat, JsonTakesTextThatIsNotUtf8) {
  EXPECT_EQ(nlohmann::json::parse(script_safe_json("\xff")), "\xEF\xBF\xBD");
}

TEST(TextFormat, NumbersForPeople) {
  EXPECT_EQ(format_value(12.3456), "12.3");
  EXPECT_EQ(format_value(0.0), "0");
  EXPECT_EQ(format_value(9.999), "10.0");
  EXPECT_EQ(format_value(-0.0123456), "-0.0123");
  EXPECT_EQ(format_value(69'870.4), "69900");
  EXPECT_EQ(format_value(1.23456e-5), "1.23e-05");
  EXPECT_EQ(format_value(2.5e7), "2.5e+07");
  EXPECT_EQ(format_value(std::nan("")), "–");
  EXPECT_EQ(format_value(std::numeric_limits<double>::infinity()), "–");
  EXPECT_EQ(rounded_to_digits(123456.0, 3), 123000.0);
}

TEST(PackedSamples, FourCharactersASample) {
  // Range 0 ... 16 777 214, so a step is 1 and the codes are the values.
  const std::vector<double> values = {0.0, 16'777'214.0, std::nan(""), 1.0};
  const PackedSamples packed = pack_samples(values);
  EXPECT_EQ(packed.lowest, 0.0);
  EXPECT_EQ(packed.step, 1.0);
  EXPECT_EQ(packed.base64, "AAAA///+////AAAB");
}

TEST(PackedSamples, ConstantEmptyAndGapsOnly) {
  const std::vector<double> constant = {4.5, 4.5};
  EXPECT_EQ(pack_samples(constant).base64, "AAAAAAAA");
  EXPECT_EQ(pack_samples(constant).lowest, 4.5);
  EXPECT_EQ(pack_samples({}).base64, "");
  const std::vector<double> gaps = {std::nan(""), std::numeric_limits<double>::infinity()};
  EXPECT_EQ(pack_samples(gaps).base64, "////////");
}

TEST(BinnedCurve, MeanAndMiddleEightyPercentOfEachBin) {
  // Bin 0: x = 0, y = 0 ... 10; bin 1: x = 1, y constant.
  std::vector<double> x;
  std::vector<double> y;
  for (int k = 0; k <= 10; ++k) {
    x.insert(x.end(), {0.0, 1.0});
    y.insert(y.end(), {static_cast<double>(k), 7.0});
  }
  x.push_back(std::nan(""));
  y.push_back(1000.0);
  const BinnedCurve curve = binned_curve(x, y, 2);
  EXPECT_EQ(curve.x, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(curve.mean, (std::vector<double>{5.0, 7.0}));
  EXPECT_EQ(curve.lower, (std::vector<double>{1.0, 7.0}));
  EXPECT_EQ(curve.upper, (std::vector<double>{9.0, 7.0}));
}

TEST(BinnedCurve, LeavesOutThinStretchesAndSurvivesNothing) {
  const std::vector<double> x = {0.0, 0.1, 10.0};
  const std::vector<double> y = {1.0, 3.0, 5.0};
  EXPECT_EQ(binned_curve(x, y, 10, 2).mean, (std::vector<double>{2.0}));
  EXPECT_TRUE(binned_curve({}, {}, 10).x.empty());
}

TEST(BinnedCurve, AGapStaysAGapAndThinBinsJoinTheirNeighbours) {
  // Dense from 0 to 9, sparse from 9 to 12, nothing until 90, dense from 90 to 100: bins of one unit.
  std::vector<double> x, y;
  for (int k = 0; k < 90; ++k) x.push_back(0.1 * k);
  for (const double thin : {9.5, 10.5, 11.5}) x.push_back(thin);
  for (int k = 0; k <= 100; ++k) x.push_back(90.0 + 0.1 * k);
  for (const double at : x) y.push_back(at > 9.2 && at < 12.0 ? 100.0 : 1.0);
  const BinnedCurve curve = binned_curve(x, y, 100, 10);
  std::size_t gaps = 0;
  double samples = 0.0;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    samples += curve.samples[k];
    if (std::isnan(curve.mean[k])) {
      ++gaps;
      EXPECT_NEAR(curve.x[k], 50.75, 1e-9) << "between the two intervals with samples";
      EXPECT_TRUE(std::isnan(curve.lower[k]) && std::isnan(curve.upper[k]));
      continue;
    }
    EXPECT_GE(curve.samples[k], 10.0);
    EXPECT_LT(curve.mean[k], 30.0) << "three outliers do not form a bin";
  }
  EXPECT_EQ(gaps, 1u);
  EXPECT_EQ(samples, static_cast<double>(x.size())) << "none is lost";
}

TEST(BinnedCurve, DoesNotAliasWithAKnownPeriod) {
  // A ripple every 5 mm over 320 mm, in 160 bins of 2 mm. Their means would beat between +-0.9.
  constexpr double kPeriod = 5.0;
  std::vector<double> x, y;
  for (int k = 0; k < 32'000; ++k) {
    x.push_back(0.01 * k);
    y.push_back(std::sin(2.0 * std::numbers::pi * x.back() / kPeriod));
  }
  for (const double mean : binned_curve(x, y, 160, 10, kPeriod).mean) EXPECT_NEAR(mean, 0.0, 0.02);
  EXPECT_DOUBLE_EQ(bin_width(2.0, 5.0), 5.0);
  EXPECT_DOUBLE_EQ(bin_width(12.0, 5.0), 15.0);
  EXPECT_DOUBLE_EQ(bin_width(0.6, 5.0), 0.625) << "fine enough to show the ripple";
  EXPECT_DOUBLE_EQ(bin_width(2.0, 0.0), 2.0);
}

TEST(ShellWord, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_word("run-1/x_2.csv"), "run-1/x_2.csv");
  EXPECT_EQ(shell_word("my drive.toml"), "'my drive.toml'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace host
