// Speed of the simulated drive as a multiple of real time, on one core.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

#include "firmware/core/axis.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "host/compare/prediction.hpp"
#include "tests/firmware/friction_drive.hpp"

namespace {

using firmware_test::kPaperX;
using firmware_test::kSamplePeriod_s;

void report(benchmark::State& state, double simulated_s) {
  state.counters["x_real_time"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsIterationInvariantRate);
}

/// The control core on the simulated board: converter, encoder, tachometer with noise, jogs both ways.
void plant_in_closed_loop(benchmark::State& state) {
  sim::Plant plant(firmware_test::friction_drive(kPaperX), 1);
  hal::pc::SimulatedAxis board(plant);
  firmware::Axis<float, hal::pc::SimulatedAxis> axis(board);
  axis.configure(firmware_test::parameters_of<float>(kPaperX));
  axis.step();
  axis.enable();
  constexpr int kSamples = 2000;
  for (auto _ : state) {
    for (int k = 0; k < kSamples; ++k) {
      if (k % 500 == 0) axis.jog(k % 1000 == 0 ? 80.0f : -80.0f);
      axis.step();
      plant.advance(kSamplePeriod_s);
    }
    benchmark::DoNotOptimize(plant.truth().x);
  }
  if (axis.telemetry().fault != firmware::AxisFault::none) state.SkipWithError("the control core stopped");
  report(state, kSamples * kSamplePeriod_s);
}
BENCHMARK(plant_in_closed_loop)->Unit(benchmark::kMillisecond);

/// Starts, reversals, plateaus and rests of some seconds.
std::vector<double> command_with_reversals() {
  std::vector<double> u_V;
  for (int k = 0; k < 10000; ++k) {
    const double t_s = kSamplePeriod_s * k;
    u_V.push_back(k % 2500 < 200 ? 0.0 : 1.6 * std::sin(9.0 * t_s) + 0.8 * std::sin(31.0 * t_s));
  }
  return u_V;
}

/// The windows of a record, each restarted, as `predict` simulates them: several in parallel, or one after the other.
template <std::size_t kTogether = host::kSideBySide>
void predict(benchmark::State& state, const sim::DriveDescription& description) {
  const sim::Drive drive(description);
  const std::vector<double> u_V = command_with_reversals();
  const std::size_t length = u_V.size() / kTogether;
  const auto simulate = [&](auto&& see) {
    std::array<sim::DriveState, kTogether> motions;
    motions.fill(drive.at(0.0, 0.0));
    for (std::size_t k = 0; k < length; ++k)
      for (std::size_t run = 0; run < kTogether; ++run) {
        const double before = motions[run].w;
        drive.step(motions[run], u_V[run * length + k], kSamplePeriod_s * static_cast<double>(k), kSamplePeriod_s);
        see(before, motions[run].w);
      }
    return motions.back().x;
  };
  for (auto _ : state) benchmark::DoNotOptimize(simulate([](double, double) {}));
  int stops = 0;
  simulate([&](double before, double after) { stops += before * after < 0.0 || (after == 0.0 && before != 0.0); });
  state.counters["stops"] = stops;
  report(state, static_cast<double>(length * kTogether) * kSamplePeriod_s);
}

void predictor_with_coulomb_sticking(benchmark::State& state) {
  sim::DriveDescription drive = firmware_test::friction_drive(kPaperX);
  std::erase_if(drive.effects, [](const sim::EffectEntry& effect) { return effect.kind == "stribeck"; });
  predict(state, drive);
}
BENCHMARK(predictor_with_coulomb_sticking)->Unit(benchmark::kMicrosecond);

void predictor_with_stribeck_friction(benchmark::State& state) {
  predict(state, firmware_test::friction_drive(kPaperX));
}
BENCHMARK(predictor_with_stribeck_friction)->Unit(benchmark::kMicrosecond);

void one_run_alone_with_stribeck_friction(benchmark::State& state) {
  predict<1>(state, firmware_test::friction_drive(kPaperX));
}
BENCHMARK(one_run_alone_with_stribeck_friction)->Unit(benchmark::kMicrosecond);

/// The typical simulation of a diagnosis: the drive with one more effect.
void predictor_with_one_effect(benchmark::State& state, const char* kind, std::map<std::string, double> parameters) {
  sim::DriveDescription drive = firmware_test::friction_drive(kPaperX);
  drive.effects.push_back({kind, std::move(parameters), {}, {}});
  predict(state, drive);
}
using Parameters = std::map<std::string, double>;
BENCHMARK_CAPTURE(predictor_with_one_effect, cogging, "cogging",
                  Parameters{{"cosine", 0.1}, {"sine", 0.1}, {"period", 2.5}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predictor_with_one_effect, input_delay, "input_delay", Parameters{{"delay", 0.0025}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predictor_with_one_effect, presliding, "presliding", Parameters{{"sigma0", 400.0}, {"sigma1", 2.0}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predictor_with_one_effect, compliance, "compliance",
                  Parameters{{"resonance", 80.0}, {"damping_ratio", 0.05}, {"load_fraction", 0.35}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predictor_with_one_effect, backlash, "backlash",
                  Parameters{{"gap", 0.05}, {"resonance", 80.0}, {"damping_ratio", 0.05}, {"load_fraction", 0.35}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predictor_with_one_effect, nonlinear_viscous, "nonlinear_viscous",
                  Parameters{{"coefficient", 0.1}, {"exponent", 0.6}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predictor_with_one_effect, dwell_stiction, "dwell_stiction",
                  Parameters{{"gain", 0.3}, {"time_constant", 0.3}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
