// Every effect of the catalogue has a picture, in the view that its entry states, and it differs from that of a machine
// without the effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/catalogue.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/workbench/served_folder.hpp"

namespace {

/// Least ratio of the RMS residual with and without the effect. Two runs that differ only in the tachometer's noise
/// differ by 1 %.
constexpr double kShows = 1.2;

/// Least share of the squares in the picture that the effect explains.
constexpr double kExplains = 0.8;

/// Catches an effect that is shown in another view than its entry states.
void expect_stated_view(const sim::EffectInfo& effect, const std::string& across) {
  constexpr const char *kMoment = "time [s]", *kStarts = "rest before the start [s]";
  EXPECT_EQ(across == kMoment, effect.view == sim::View::moment) << effect.kind << ": " << across;
  EXPECT_EQ(across == kStarts, effect.view == sim::View::starts) << effect.kind << ": " << across;
}

TEST(Gallery, EachEffectHasAPictureThatDiffersFromThatWithoutIt) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const ServedFolder served;
  for (const sim::EffectInfo* effect : sim::catalogue()) {
    const std::string kind(effect->kind);
    const auto [status, told] = served.get("/api/effects/" + kind + "/picture");
    ASSERT_EQ(status, 200) << kind << told;
    EXPECT_GT(told["stands_out"].get<double>(), kShows) << kind;
    EXPECT_FALSE(told["plot"]["series"].empty()) << kind;
    if (effect->stage == sim::Stage::table || effect->base) continue;
    expect_stated_view(*effect, told["plot"]["xLabel"]);
    EXPECT_GT(told["explained"].get<double>(), kExplains) << kind;
    RecordProperty(kind + "_explained", std::to_string(told["explained"].get<double>()));
    RecordProperty(kind, std::to_string(told["stands_out"].get<double>()));
  }
  EXPECT_EQ(served.get("/api/effects/nothing/picture").first, 400);
}

}  // namespace
