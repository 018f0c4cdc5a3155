// Planned runs on a simulated board, over its protocol.
#include "host/response/response_measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/axis_design.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/response/axis_response.hpp"
#include "host/simulated_board/simulated_link.hpp"
#include "host/statistics.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

constexpr double kResonance_Hz = 110.0;

sim::DriveDescription machine_with_spring() {
  sim::DriveDescription machine = *host::paper_drive("x");
  sim::EffectEntry spring;
  spring.kind = "compliance";
  spring.parameters = {{"resonance", kResonance_Hz}, {"damping_ratio", 0.04}, {"load_fraction", 0.3}};
  machine.effects.push_back(spring);
  return machine;
}

class MeasuredOnABoard : public testing::Test {
 protected:
  MeasuredOnABoard() {
    values_ = board_.read_values();
    const sim::DriveDescription model = *host::paper_drive("x");
    const std::string text = host::board_parameters_toml(model, host::design_axis(model, {}));
    for (const host::Assignment& one : host::parse_parameter_text(text, "design", "x")) host::put(values_, one);
    board_.write_values(values_);
    scale_ = host::excitation_scale(values_, 0, sim::DriveKind::rotary);
    parameters_ = firmware::axis_parameters<float>(values_.axis(0));
  }

  host::BoardClient board_{
      std::make_unique<host::SimulatedLink>(host::SimulatedDeviceOptions{{{machine_with_spring()}}, {}, 3})};
  firmware::ParameterValues values_;
  host::ExcitationScale scale_;
  firmware::AxisParameters<float> parameters_;
};

/// Catches runs that reverse, stand still or excite the wrong axis: the spring could not be found.
TEST_F(MeasuredOnABoard, ASpringIsFoundThatTheDesignDidNotKnow) {
  const host::ResponsePlan plan{.box = {60.0, 100.0, 4.0, 120.0}};
  std::vector<host::Record> records;
  host::measure_axis(
      board_, 0, plan, values_, scale_, [] { return false; }, records);
  double motion_s = 0.0;
  for (const host::Record& record : records) {
    motion_s += record.t_s.back();
    const auto [least, most] = std::ranges::minmax_element(record.x);
    EXPECT_LT(*most - *least, plan.box.travel / 2.0);
    EXPECT_LT(host::largest_magnitude(record.w) * scale_.lead, plan.box.speed);
  }
  EXPECT_LT(motion_s, 1.1 * plan.box.time_s);
  const host::AxisResponse axis = host::analyse_response(records, &parameters_);
  ASSERT_TRUE(axis.fit && axis.margins);
  ASSERT_EQ(axis.fit->resonances.size(), 1u);
  EXPECT_NEAR(axis.fit->resonances[0].f_Hz.value, kResonance_Hz, 0.01 * kResonance_Hz);
  EXPECT_NEAR(axis.fit->resonances[0].damping.value, 0.04, 0.01);
  EXPECT_TRUE(axis.margins->is_stable);
  ASSERT_TRUE(axis.margins->modulus && axis.margins->crossover_Hz);
  EXPECT_LT(axis.margins->modulus->ci95[1] - axis.margins->modulus->ci95[0], 0.05);
  EXPECT_EQ(board_.status().axis[0].state, static_cast<std::uint8_t>(firmware::SupervisorState::ready));
}

/// A response that is written and read again gives the same margins.
TEST_F(MeasuredOnABoard, AResponseSurvivesItsFile) {
  std::vector<host::Record> records;
  host::make_response_runs(
      board_, 0, host::plan_response({.box = {60.0, 100.0, 4.0, 60.0}}, scale_, parameters_), values_, scale_,
      [] { return false; }, records);
  const host::AxisResponse axis = host::analyse_response(records, &parameters_);
  const TemporaryFolder folder;
  std::ofstream(folder.path("r.json")) << host::response_json(axis).dump();
  const host::AxisResponse again = host::with_controller(host::read_response(folder.path("r.json")), parameters_);
  ASSERT_TRUE(axis.margins && again.margins && axis.margins->phase_deg && again.margins->phase_deg);
  EXPECT_NEAR(axis.margins->phase_deg->value, again.margins->phase_deg->value, 1e-6);
  EXPECT_NEAR(axis.margins->phase_deg->ci95[0], again.margins->phase_deg->ci95[0], 1e-6);
}

/// A light axis with a long lead has a large response. If the plan ignores the monitor, the axis stops with a following
/// error.
TEST_F(MeasuredOnABoard, TheAnswerStaysWellWithinTheFollowingErrorThatIsWatched) {
  const auto lowest_V = [&](float watched_mm) {
    parameters_.monitors.following_error_floor = watched_mm;
    parameters_.monitors.following_error_per_velocity = 0.0F;
    const auto runs = host::plan_response({.box = {60.0, 100.0, 4.0, 60.0}}, scale_, parameters_);
    return std::stod(runs.front().header.at("excitation_amplitude"));
  };
  EXPECT_NEAR(lowest_V(0.02F), 0.5 * lowest_V(0.04F), 1e-3 * lowest_V(0.04F));
  EXPECT_LT(lowest_V(0.04F), lowest_V(4.0F));
}

TEST_F(MeasuredOnABoard, TooNarrowABoxIsRefusedBeforeAnythingMoves) {
  const auto code_of = [&](const host::ResponsePlan& plan) {
    try {
      host::plan_response(plan, scale_, parameters_);
    } catch (const host::Failure& failure) {
      return failure.code;
    }
    return host::ExitCode::done;
  };
  EXPECT_EQ(code_of({.box = {60.0, 100.0, 4.0, 5.0}}), host::ExitCode::refused) << "time";
  EXPECT_EQ(code_of({.box = {0.1, 100.0, 4.0, 60.0}}), host::ExitCode::refused) << "travel";
  EXPECT_EQ(code_of({.box = {60.0, 100.0, 4.0, 60.0}, .to_Hz = 600.0}), host::ExitCode::usage);
}

}  // namespace
