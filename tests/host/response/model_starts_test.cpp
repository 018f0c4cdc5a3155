// Values of a fit that are used for a model, and values that are not.
#include "host/response/model_starts.hpp"

#include <gtest/gtest.h>

#include "host/model/model_file.hpp"

namespace {

host::PlantFit fit_with(double f_Hz, double speed_share, double delay_s) {
  host::PlantFit fit;
  fit.sample_period_s = 1e-3;
  fit.delay_s = {delay_s, {0.8 * delay_s, 1.2 * delay_s}};
  host::Resonance mode;
  mode.f_Hz = {f_Hz, {0.99 * f_Hz, 1.01 * f_Hz}};
  mode.damping = {0.04, {0.03, 0.05}};
  mode.position_share = -1.0;
  mode.speed_share = speed_share;
  fit.resonances = {mode};
  return fit;
}

sim::DriveDescription model() {
  return host::read_model(std::string(AXIS_TEST_DATA) + "/drive-cases/none/case-00/model.toml");
}

TEST(ModelStarts, TakeASpringAndADelayThatAModelCanHold) {
  const host::ModelStarts starts = host::with_response(model(), fit_with(90.0, 0.25, 8e-4), "bode");
  const sim::EffectEntry* spring = starts.model.find("compliance");
  ASSERT_NE(spring, nullptr);
  EXPECT_EQ(spring->at("resonance"), 90.0);
  EXPECT_NEAR(spring->at("load_fraction"), 0.2, 1e-12) << "a quarter of the motor's inertia is a fifth of both";
  ASSERT_NE(starts.model.find("input_delay"), nullptr);
  EXPECT_EQ(starts.model.find("input_delay")->at("delay"), 8e-4);
  EXPECT_NO_THROW(host::parse_model(host::format_model(starts.model), "written"));
}

TEST(ModelStarts, TakeALagAsTheBandwidthOfTheCurrentLoop) {
  host::PlantFit fit = fit_with(2000.0, 0.25, 0.0);
  fit.lag_s = {1e-3, {0.8e-3, 1.25e-3}};
  const host::ModelStarts starts = host::with_response(model(), fit, "bode");
  EXPECT_EQ(starts.model.find("input_delay"), nullptr);
  const sim::EffectEntry* lag = starts.model.find("current_loop_lag");
  ASSERT_NE(lag, nullptr);
  EXPECT_NEAR(lag->at("bandwidth"), 159.15, 0.01);
  EXPECT_NEAR(lag->ci95.at("bandwidth")[0], 127.32, 0.01);
  EXPECT_NEAR(lag->ci95.at("bandwidth")[1], 198.94, 0.01);
}

TEST(ModelStarts, LeaveOutWhatNoDriveHas) {
  EXPECT_EQ(host::with_response(model(), fit_with(90.0, -1.0, 1e-5), "bode").model.find("compliance"), nullptr)
      << "seen at the load alone";
  EXPECT_EQ(host::with_response(model(), fit_with(2000.0, 0.25, 1e-5), "bode").model.find("compliance"), nullptr)
      << "beyond the catalogue's bounds";
  EXPECT_EQ(host::with_response(model(), fit_with(90.0, 0.25, 1e-5), "bode").model.find("input_delay"), nullptr)
      << "a hundredth of a period";
}

}  // namespace
