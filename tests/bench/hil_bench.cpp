// Speed of the complete machine: two axes with all monitors and captures, and two simulated drives.
#include <benchmark/benchmark.h>

#include "host/hil/scenario_run.hpp"

namespace {

void hil_scenario(benchmark::State& state, const char* name) {
  host::Scenario scenario = host::read_scenario(std::string(AXIS_TEST_DATA "/../../host/hil/scenarios/") + name);
  for (auto& axis : scenario.axes)
    axis.knowledge = host::Knowledge::truth;  // measures the run without an identification
  for (auto _ : state) benchmark::DoNotOptimize(host::run_scenario(scenario));
  state.counters["x_real_time"] =
      benchmark::Counter(scenario.duration_s, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(hil_scenario, circle, "circle.toml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(hil_scenario, worn_machine, "worn-machine.toml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(hil_scenario, emergency_stop, "fault-emergency-stop.toml")->Unit(benchmark::kMillisecond);

}  // namespace
