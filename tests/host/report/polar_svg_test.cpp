#include "host/report/polar_svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_THAT(svg, HasSubstr("M484.0 280.0"));            // 280 + 160 + 2 * 22
  EXPECT_THAT(svg, HasSubstr("L280.0 172.8"));            // 280 - (160 - 12/5 * 22)
  EXPECT_THAT(svg, HasSubstr("aria-label=\"A &lt;circle&gt;; spoilt: -12.0 to 10.0 µm\""));
}

TEST(PolarPlot, NothingAndNothingFiniteAreDrawnWithoutTraces) {
  EXPECT_THAT(html::polar_plot({"empty", "", 1.0, {}}), HasSubstr("rings are 1 µm apart"));
  EXPECT_THAT(html::polar_plot({"nan", "", 1.0, {{"a", SeriesRole::before, {0.0}, {std::nan("")}}}}),
              HasSubstr("d=\"\""));
}

}  // namespace
}  // namespace host
