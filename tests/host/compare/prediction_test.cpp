// Windows that are simulated in parallel.
#include "host/compare/prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/compare/comparison.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

TEST(Prediction, OfAWindowIsTheSameInAnyCompany) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = HandMade::model();
  model.effects.push_back({"input_delay", {{"delay", 0.0025}}, {}, {}});
  const sim::Drive drive(model);
  const host::PreparedRecord prepared = host::prepare(record, model);
  ASSERT_GT(prepared.windows.size(), 2 * host::kSideBySide);
  for (const std::size_t stride : {1, 3}) {
    host::Prediction together;
    host::predict(drive, prepared, together, stride);
    const std::vector<sim::DriveState> states = host::restart_states(drive, prepared, stride);
    for (std::size_t index = 0; index < prepared.windows.size(); index += stride) {
      const host::Window& window = prepared.windows[index];
      std::vector<double> x(window.length), w(window.length);
      host::WindowRun alone{&window, states[index / stride], x.data(), w.data()};
      host::run_side_by_side(drive, prepared, {&alone, 1});
      for (std::size_t k = 0; k < window.length; ++k) {
        ASSERT_EQ(together.x[window.begin + 1 + k], x[k]) << "window " << index;
        ASSERT_EQ(together.w[window.begin + 1 + k], w[k]) << "window " << index;
      }
    }
  }
}

/// The model contains the errors of encoder and converter, so neither may change the prediction error, with one mass or
/// two.
TEST(Prediction, IsAsGoodBehindAKnownErrorOfEncoderOrConverter) {
  constexpr double kWave_mm = 0.03, kPeriod_mm = 4.0, kOffset_V = 0.4;
  constexpr double kNear = 0.1;  // noise floors
  const host::Record record = HandMade::record();
  const double step = HandMade::model().data.encoder_resolution;
  host::Record wavy = record, shifted = record;
  for (double& x : wavy.x)
    x = step * std::round((x + kWave_mm * std::cos(2.0 * std::numbers::pi * x / kPeriod_mm)) / step);
  for (double& u_V : shifted.u_V) u_V -= kOffset_V;
  const auto error = [](const host::Record& of, const sim::DriveDescription& model) {
    return host::error_of(sim::Drive(model), host::compare_on({&of}, model)).combined;
  };
  sim::DriveDescription two_masses = HandMade::model();
  two_masses.effects.push_back(
      {"compliance", {{"resonance", 60.0}, {"damping_ratio", 0.1}, {"load_fraction", 0.3}}, {}, {}});
  for (const sim::DriveDescription& model : {HandMade::model(), two_masses}) {
    sim::DriveDescription waves = model, offset = model;
    waves.effects.push_back(
        {"encoder_cyclic_error", {{"cosine", kWave_mm}, {"sine", 0.0}, {"period", kPeriod_mm}}, {}, {}});
    offset.effects.push_back({"dac_offset", {{"offset", kOffset_V}}, {}, {}});
    const double before = error(record, model);
    EXPECT_NEAR(error(wavy, waves), before, kNear) << model.effects.back().kind;
    EXPECT_NEAR(error(shifted, offset), before, kNear) << model.effects.back().kind;
  }
}

}  // namespace
