// How long a diagnosis takes, all candidates and pairs: on a case with one hidden effect, on the same data twice over,
// with two effects, and with none.
#include <benchmark/benchmark.h>

#include <numeric>

#include "tests/host/diagnose/drive_case.hpp"

namespace {

/// The records of a shipped case, each as often as state.range(0) says, every time with another zero of its position:
/// rows that are the same would count once.
void diagnosis_of_a_case(benchmark::State& state, const char* name) {
  const DriveCase hidden(name);
  const auto copies = [&](const std::vector<host::Record>& records) {
    std::vector<host::Record> result;
    for (int64_t copy = 0; copy < state.range(0); ++copy)
      for (host::Record record : records) {
        for (double& x : record.x) x += static_cast<double>(copy) * 7.0 * hidden.model.data.encoder_resolution;
        result.push_back(std::move(record));
      }
    return result;
  };
  const host::Measurements measured =
      host::MeasurementGate(hidden.model).admit(copies(hidden.train), copies(hidden.validate));
  for (auto _ : state) benchmark::DoNotOptimize(host::diagnose(hidden.model, measured).after_validate);
  const auto samples = [](const std::vector<host::Record>& records) {
    return std::accumulate(records.begin(), records.end(), 0.0, [](double sum, const host::Record& record) {
      return sum + static_cast<double>(record.size());
    });
  };
  state.counters["samples"] = samples(measured.training()) + samples(measured.validation());
}
BENCHMARK_CAPTURE(diagnosis_of_a_case, cogging, "single/case-00")
    ->Arg(1)
    ->Arg(2)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(diagnosis_of_a_case, asymmetry_and_lag, "pairs/case-00")
    ->Arg(1)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(diagnosis_of_a_case, nothing_hidden, "none/case-00")
    ->Arg(1)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
