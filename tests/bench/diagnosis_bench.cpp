// How long a diagnosis takes, all candidates and pairs: on a case with one hidden effect, on the same data twice over,
// with two effects, and with none.
#include <benchmark/benchmark.h>

#include <numeric>

#include "tests/host/diagnose/drive_case.hpp"

namespace {

/// The records of a shipped case, each as often as state.range(0) says.
void diagnosis_of_a_case(benchmark::State& state, const char* name) {
  const DriveCase hidden(name);
  std::vector<const host::Record*> train, validate;
  for (int64_t copy = 0; copy < state.range(0); ++copy) {
    for (const host::Record& record : hidden.train) train.push_back(&record);
    for (const host::Record& record : hidden.validate) validate.push_back(&record);
  }
  for (auto _ : state) benchmark::DoNotOptimize(host::diagnose(hidden.model, train, validate).after_validate);
  const auto samples = [](const std::vector<const host::Record*>& records) {
    return std::accumulate(records.begin(), records.end(), 0.0, [](double sum, const host::Record* record) {
      return sum + static_cast<double>(record->size());
    });
  };
  state.counters["samples"] = samples(train) + samples(validate);
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
