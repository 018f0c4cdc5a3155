// Duration of writing a report.
#include <benchmark/benchmark.h>

#include <cmath>

#include "host/report/report.hpp"

namespace {

/// Measured, predicted and residual of one record of `state.range(0)` samples.
void report_of_a_record(benchmark::State& state) {
  const auto samples = static_cast<std::size_t>(state.range(0));
  host::TimePlot plot;
  plot.panels = {{"speed", "rad/s", {{"measured", host::SeriesRole::measured, {}}}},
                 {"speed error", "rad/s", {{"residual", host::SeriesRole::residual, {}}}}};
  for (std::size_t k = 0; k < samples; ++k) {
    plot.t_s.push_back(0.001 * static_cast<double>(k));
    plot.panels[0].traces[0].values.push_back(std::sin(plot.t_s.back()));
    plot.panels[1].traces[0].values.push_back(std::cos(17.0 * plot.t_s.back()));
  }
  host::Report report("benchmark");
  report.add(plot);
  std::size_t bytes = 0;
  for (auto _ : state) {
    const std::string html = report.html();
    bytes = html.size();
    benchmark::DoNotOptimize(bytes);
  }
  state.counters["samples/s"] =
      benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(report_of_a_record)->Arg(70'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
