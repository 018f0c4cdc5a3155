// Duration of a diagnosis with all candidates and pairs, and the peak memory of the program: shipped cases with one,
// two and no effects; all public cases if their folder exists; and diagnosis and improvement on a long record with a
// low sampling rate.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <numeric>

#include "host/diagnose/improvement.hpp"
#include "sim/plant.hpp"
#include "tests/firmware/friction_drive.hpp"
#include "tests/host/diagnose/drive_case.hpp"

namespace {

double samples_of(const std::vector<host::Record>& records) {
  return std::accumulate(records.begin(), records.end(), 0.0, [](double sum, const host::Record& record) {
    return sum + static_cast<double>(record.size());
  });
}

void report(benchmark::State& state, const host::Measurements& measured) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["samples"] = samples_of(measured.training()) + samples_of(measured.validation());
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void diagnosis_of(benchmark::State& state, const sim::DriveDescription& model, const host::Measurements& measured) {
  for (auto _ : state) benchmark::DoNotOptimize(host::diagnose(model, measured).after_validate);
  report(state, measured);
}

void diagnosis_of_a_case(benchmark::State& state, const std::string& name) {
  const DriveCase hidden(name);
  diagnosis_of(state, hidden.model, host::MeasurementGate(hidden.model).admit(hidden.train, hidden.validate));
}

template <typename... Arguments>
void once(const std::string& name, Arguments... arguments) {
  benchmark::RegisterBenchmark(name.c_str(), arguments...)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);
}

/// 43 s and 10 s of a drive with backlash, sampled at 100 Hz: reversals at several speeds, and rests.
std::vector<host::Record> slow_records(const sim::DriveDescription& machine) {
  std::vector<host::Record> records;
  for (const double duration_s : {43.0, 10.0}) {
    sim::Plant plant(machine, records.size() + 1);
    host::Record record;
    record.path = std::string("slow.csv");
    record.drive = machine.name;
    record.sample_period_s = 0.01;
    for (double t_s = 0.0; t_s < duration_s; t_s += record.sample_period_s) {
      const double u_V = std::fmod(t_s, 5.0) < 0.6 ? 0.0 : 1.6 * std::sin(6.0 * t_s) + 0.6 * std::sin(1.7 * t_s * t_s);
      plant.set_command(u_V);
      record.t_s.push_back(t_s);
      record.u_V.push_back(plant.command_V());
      record.x.push_back(machine.data.encoder_resolution * static_cast<double>(plant.encoder_counts()));
      record.w.push_back(plant.read_tachometer().value_or(0.0));
      plant.advance(record.sample_period_s);
    }
    records.push_back(std::move(record));
  }
  return records;
}

struct SlowSampler {
  sim::DriveDescription known = firmware_test::friction_drive(firmware_test::kPaperX);
  host::Measurements measured = [this] {
    known.name = "x";
    known.data.sample_period_s = 0.01;
    sim::DriveDescription machine = known;
    machine.effects.push_back(
        {"backlash", {{"gap", 0.08}, {"resonance", 200.0}, {"damping_ratio", 0.05}, {"load_fraction", 0.5}}, {}, {}});
    const std::vector<host::Record> records = slow_records(machine);
    return host::MeasurementGate(known).admit({records[0]}, {records[1]});
  }();
};

void diagnosis_of_a_slow_sampler(benchmark::State& state) {
  const SlowSampler slow;
  diagnosis_of(state, slow.known, slow.measured);
}

void improvement_of_a_slow_sampler(benchmark::State& state) {
  const SlowSampler slow;
  for (auto _ : state) benchmark::DoNotOptimize(host::improve(slow.known, slow.measured).ladder.size());
  report(state, slow.measured);
}

const bool kRegistered = [] {
  once("diagnosis_of_a_case/cogging", diagnosis_of_a_case, "single/case-00");
  once("diagnosis_of_a_case/asymmetry_and_lag", diagnosis_of_a_case, "pairs/case-00");
  once("diagnosis_of_a_case/nothing_hidden", diagnosis_of_a_case, "none/case-00");
  once("diagnosis_of_a_slow_sampler", diagnosis_of_a_slow_sampler);
  once("improvement_of_a_slow_sampler", improvement_of_a_slow_sampler);
  // A folder beside the project; its cases are named by their full path.
  const std::filesystem::path cases = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases";
  if (!std::filesystem::exists(cases)) return false;
  for (const auto& each : std::filesystem::recursive_directory_iterator(cases))
    if (std::filesystem::exists(each.path() / "model.toml"))
      once("diagnosis_of_a_public_case/" + std::filesystem::relative(each.path(), cases).string(), diagnosis_of_a_case,
           each.path().string());
  return true;
}();

}  // namespace
