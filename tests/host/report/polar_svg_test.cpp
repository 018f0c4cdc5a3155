#include "host/report/polar_svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>

namespace host {
namespace {

using testing::HasSubstr;

TEST(PolarPlot, SaysHowMuchItMagnifiesAndDrawsToThatScale) {
  // Rings of 22 units about a circle of 160: the largest deviation, 12 um, covers three rings of 5 um.
  const PolarPlot plot{
      "A <circle>", "", 35.0, {{"spoilt", SeriesRole::before, {0.0, 1.5707963267948966}, {10.0, -12.0}}}};
  const std::string svg = html::polar_plot(plot);
  EXPECT_THAT(svg, HasSubstr("rings are 5 µm apart"));
  EXPECT_THAT(svg, HasSubstr("drawn 962 times larger"));  // (22/5 a um) / (160/35000 a um) = 962.5
  EXPECT_THAT(svg, HasSubstr("M504.0 300.0"));            // 300 + 160 + 2 * 22
  EXPECT_THAT(svg, HasSubstr("L300.0 192.8"));            // 300 - (160 - 12/5 * 22)
  EXPECT_THAT(svg, HasSubstr("aria-label=\"A &lt;circle&gt;; spoilt: -12.0 to 10.0 µm\""));
}

TEST(PolarPlot, TellsTwoFeedsOfOneDirectionApart) {
  const PolarTrace one{"slow", SeriesRole::before, {0.0, 1.0}, {10.0, -12.0}};
  const std::string svg = html::polar_plot({"two", "", 35.0, {one, one}});
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray:1 0"));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray:6 4"));
}

TEST(PolarPlot, KeepsItsLettersInThePicture) {
  // The widest picture has four rings; half of "+X" is 12 wide, and 19 on a phone.
  const std::string svg = html::polar_plot({"wide", "", 35.0, {{"far", SeriesRole::before, {0.0}, {20.0}}}});
  std::smatch letter, size;
  ASSERT_TRUE(std::regex_search(svg, letter, std::regex("<text x=\"([0-9.]+)\"[^>]*>\\+X")));
  ASSERT_TRUE(std::regex_search(svg, size, std::regex("viewBox=\"0 0 ([0-9.]+) ")));
  EXPECT_LT(std::stod(letter[1]) + 19.0, std::stod(size[1]));
}

TEST(PolarPlot, NothingAndNothingFiniteAreDrawnWithoutTraces) {
  EXPECT_THAT(html::polar_plot({"empty", "", 1.0, {}}), HasSubstr("rings are 1 µm apart"));
  EXPECT_THAT(html::polar_plot({"nan", "", 1.0, {{"a", SeriesRole::before, {0.0}, {std::nan("")}}}}),
              HasSubstr("d=\"\""));
}

}  // namespace
}  // namespace host
