// A controller is judged before anything is written: on the response that the model predicts, and in motion.
#include "host/hil/designed_loop.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/identify/paper_drives.hpp"

namespace {

using host::DesignedLoop;
using host::DesignOptions;
using host::LoopAim;

DesignOptions options_at(double bandwidth_Hz) {
  DesignOptions options;
  options.bandwidth_Hz = bandwidth_Hz;
  return options;
}

DesignedLoop designed(const sim::DriveDescription& model, double bandwidth_Hz, const LoopAim& aim = {}) {
  return host::designed_loop(model, options_at(bandwidth_Hz), aim, {}, host::modelled_response(model));
}

sim::DriveDescription with_dead_time(double delay_s) {
  sim::DriveDescription model = *host::paper_drive("x");
  model.effects.push_back({"input_delay", {{"delay", delay_s}}, {}, ""});
  return model;
}

double modulus_of(const DesignedLoop& loop) { return loop.loop->after.margins->modulus->value; }

TEST(DesignedLoop, MarginsOnTheModelsResponseFallWithBandwidthAndDeadTime) {
  const sim::DriveDescription quick = *host::paper_drive("x"), late = with_dead_time(0.0005);
  EXPECT_GT(modulus_of(designed(quick, 20.0)), modulus_of(designed(quick, 60.0)));
  EXPECT_GT(modulus_of(designed(quick, 30.0)), modulus_of(designed(late, 30.0)) + 0.05);
  // Without noise the interval of a margin is the value itself.
  const host::Interval95 modulus = *designed(quick, 30.0).loop->after.margins->modulus;
  EXPECT_NEAR(modulus.ci95[0], modulus.value, 1e-3);
  EXPECT_NEAR(modulus.ci95[1], modulus.value, 1e-3);
}

TEST(DesignedLoop, FindsTheFastestLoopWithAMarginAndRefusesAnUnstableOne) {
  const sim::DriveDescription late = with_dead_time(0.0005);
  LoopAim aim;
  aim.modulus = 0.5;
  const DesignedLoop fastest = designed(late, 30.0, aim);
  EXPECT_GE(modulus_of(fastest), 0.5);
  EXPECT_LT(modulus_of(designed(late, 1.1 * fastest.design.used.bandwidth_Hz)), 0.5);
  EXPECT_THROW(designed(with_dead_time(0.004), 30.0), host::Failure);
}

TEST(DesignedLoop, ThePageShowsStepAndFollowingErrorOfBothControllers) {
  const sim::DriveDescription model = *host::paper_drive("x");
  const DesignedLoop loop = designed(model, 50.0);
  const std::string page = host::designed_loop_report(model, loop, options_at(50.0)).html();
  for (const char* part : {"Modulus margin", "Open loop", "Predicted motion", "Step of", "following error"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  const DesignedLoop by_model_alone = host::designed_loop(model, {}, {}, {}, std::nullopt);
  EXPECT_FALSE(by_model_alone.loop);
  const std::string alone = host::designed_loop_report(model, by_model_alone, {}).html();
  EXPECT_NE(alone.find("Predicted motion"), std::string::npos);
  EXPECT_NE(alone.find("largest following error, designed"), std::string::npos);
  EXPECT_EQ(alone.find("largest following error before"), std::string::npos);
}

TEST(DesignedLoop, ThePageMovesTheAxisAtTheWrittenLimitsAndSaysWhatSetsThem) {
  const sim::DriveDescription model = *host::paper_drive("x");
  host::LimitWishes wishes;
  wishes.as_the_drive_allows = true;
  wishes.top_speed_mm_s = 100.0;
  const DesignedLoop loop = host::designed_loop(model, {}, {}, wishes, std::nullopt);
  const std::string page = host::designed_loop_report(model, loop, {}).html();
  EXPECT_NE(page.find(loop.limits.jerk.by), std::string::npos);
  const auto [v, a, j] = loop.limits.written;
  EXPECT_NE(page.find(fmt::format("Move over {:.3g} mm", v * (v / a + a / j + 0.1))), std::string::npos);
}

}  // namespace
