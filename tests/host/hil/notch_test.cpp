// A resonance that limits the bandwidth, measured on the machine, and a notch designed from the measurement.
#include <gtest/gtest.h>

#include <cstdio>

#include "host/hil/scenario_run.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/response/loop_design.hpp"
#include "host/response/response_measurement.hpp"
#include "host/simulated_board/simulated_link.hpp"
#include "host/statistics.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

constexpr double kModulus = 0.5;

/// Response measured over the board's protocol, with the controller designed from the model without a spring.
host::AxisResponse measured(const sim::DriveDescription& machine, const sim::DriveDescription& model,
                            double bandwidth_Hz) {
  host::BoardClient board(std::make_unique<host::SimulatedLink>(host::SimulatedDeviceOptions{{{machine}}, {}, 3}));
  firmware::ParameterValues values = board.read_values();
  host::DesignOptions options;
  options.bandwidth_Hz = bandwidth_Hz;
  sim::DriveDescription named = model;
  named.name = std::string(host::kAxisNames[0]);
  const std::string text = host::board_parameters_toml(named, host::design_axis(named, options));
  for (const host::Assignment& one : host::parse_parameter_text(text, "design", "x")) host::put(values, one);
  board.write_values(values);
  const host::ExcitationScale scale = host::excitation_scale(values, 0, machine.data.kind);
  std::vector<host::Record> records;
  host::measure_axis(
      board, 0, {.box = {80.0, 120.0, 5.0, 120.0}}, values, scale, [] { return false; }, records);
  return host::analyse_response(records, nullptr);
}

host::LoopAim aim(bool seek_notch) {
  host::LoopAim aim;
  aim.modulus = kModulus;
  aim.seek_notch = seek_notch;
  return aim;
}

TEST(Notch, LetsTheBandwidthRiseByAThirdAtTheSameMarginAndTheCircleGainsByIt) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const std::string folder = AXIS_TEST_DATA "/../../host/hil/scenarios/";
  host::Scenario plain = host::read_scenario(folder + "compliance.toml");
  host::Scenario notched = plain;
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    const sim::DriveDescription model = *host::paper_drive(host::kAxisNames[i]);
    const host::AxisResponse response = measured(plain.axes[i].drive, model, 15.0);
    const host::DesignOptions options;
    const host::LoopDesign without = host::design_loop(model, options, aim(false), response);
    const host::LoopDesign with = host::design_loop(model, options, aim(true), response);
    ASSERT_TRUE(with.filters.notch && without.after.margins->modulus && with.after.margins->modulus);
    std::printf(
        "axis %s: %.1f Hz (crossover %.1f, modulus %.3f) without, %.1f Hz (crossover %.1f, modulus %.3f) with a notch "
        "at "
        "%.1f Hz, damping %g, depth %g\n",
        std::string(host::kAxisNames[i]).c_str(), without.design.used.bandwidth_Hz,
        without.after.margins->crossover_Hz->value, without.after.margins->modulus->value,
        with.design.used.bandwidth_Hz, with.after.margins->crossover_Hz->value, with.after.margins->modulus->value,
        with.filters.notch->f_Hz, with.filters.notch->damping, with.filters.notch->depth);
    EXPECT_GE(with.design.used.bandwidth_Hz, 4.0 / 3.0 * without.design.used.bandwidth_Hz);
    EXPECT_GE(with.after.margins->modulus->value, 0.98 * kModulus);
    plain.axes[i].tuning = {without.design.used.bandwidth_Hz, without.filters};
    notched.axes[i].tuning = {with.design.used.bandwidth_Hz, with.filters};
  }
  // RMS, because the largest error is a single sample at a reversal, which changes by a tenth with the rounding of the
  // friction curve.
  const double before = host::root_mean_square(host::run_scenario(plain).contour_um),
               after = host::root_mean_square(host::run_scenario(notched).contour_um);
  std::printf("contour error of the circle: %.2f um RMS before, %.2f um after\n", before, after);
  EXPECT_LT(after, 3.0 / 4.0 * before);
}

}  // namespace
