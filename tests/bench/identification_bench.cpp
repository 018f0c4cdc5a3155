// Identification of a million samples, relative to reading the arrays once and forming Phi'Phi.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "host/evidence/measurement_gate.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/identify/rigid_estimate.hpp"
#include "sim/drive.hpp"

namespace {

constexpr std::size_t kSamples = 1'000'000;
constexpr double kDeadBand_rad_s = 0.5;  // the program's default

/// A record of the paper's x drive with doublets of up to 10 V and exact motion.
const host::Record& long_record() {
  static const host::Record record = [] {
    const sim::DriveDescription description = host::paper_drive("x").value();
    const sim::Drive drive(description);
    host::Record made;
    made.path = std::string("simulated x");
    made.drive = description.name;
    made.sample_period_s = 0.001;
    sim::DriveState state = drive.at(0.0, 0.0);
    for (std::size_t k = 0; k < kSamples; ++k) {
      const std::size_t phase = k % 400;
      const double level_V = 4.0 + static_cast<double>(k / 400 % 7);
      const double u_V = phase < 50 || phase >= 250 ? level_V : (phase < 200 ? -level_V : 0.0);
      made.t_s.push_back(0.001 * static_cast<double>(k));
      made.u_V.push_back(u_V);
      made.x.push_back(state.x);
      made.w.push_back(drive.tachometer(state));
      drive.step(state, u_V, made.t_s.back(), 0.001);
    }
    return made;
  }();
  return record;
}

/// The reference: one pass over the arrays with four regressors.
void form_normal_equations(const host::Record& record) {
  Eigen::Matrix4d moment = Eigen::Matrix4d::Zero();
  Eigen::Vector4d projection = Eigen::Vector4d::Zero();
  for (std::size_t k = 1; k < kSamples; ++k) {
    const double w = record.w[k - 1];
    const Eigen::Vector4d phi(w, record.u_V[k - 1], w > kDeadBand_rad_s ? -1.0 : 0.0,
                              w < -kDeadBand_rad_s ? -1.0 : 0.0);
    moment.noalias() += phi * phi.transpose();
    projection.noalias() += phi * record.w[k];
  }
  benchmark::DoNotOptimize(moment);
  benchmark::DoNotOptimize(projection);
}

/// Processor time of one pass, the shortest of ten.
double one_pass_s() {
  static const double shortest_s = [] {
    double shortest = HUGE_VAL;
    for (int run = 0; run < 10; ++run) {
      const std::clock_t start = std::clock();
      form_normal_equations(long_record());
      shortest = std::min(shortest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return shortest;
  }();
  return shortest_s;
}

/// Runs `work` in the benchmark's loop and reports its processor time relative to that of one pass.
template <typename Work>
void measure(benchmark::State& state, const Work& work) {
  const double yardstick_s = one_pass_s();
  const std::clock_t start = std::clock();
  for (auto _ : state) work();
  const double each_s =
      static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / static_cast<double>(state.iterations());
  state.counters["samples/s"] = static_cast<double>(kSamples) / each_s;
  state.counters["x_one_pass"] = each_s / yardstick_s;
}

void form_normal_equations_only(benchmark::State& state) {
  measure(state, [] { form_normal_equations(long_record()); });
}
BENCHMARK(form_normal_equations_only)->Unit(benchmark::kMillisecond);

/// Estimate, intervals and condition number.
void unbiased_least_squares(benchmark::State& state) {
  const std::vector<host::Record> records = {long_record()};
  const sim::DataSheet data = host::paper_drive("x")->data;
  measure(state, [&] {
    benchmark::DoNotOptimize(
        host::discrete_least_squares(records, data, kDeadBand_rad_s, host::Coulomb::estimated).inertia.value);
  });
}
BENCHMARK(unbiased_least_squares)->Unit(benchmark::kMillisecond);

/// The whole command after reading the file: faults of the log, excitation check, calibration, filters,
/// estimate, relative error.
void whole_identification(benchmark::State& state, host::IdentificationMethod method) {
  const std::vector<host::Record> records = {long_record()};
  const sim::DriveDescription drive = host::paper_drive("x").value();
  measure(state, [&] {
    const host::Measurements measured = host::MeasurementGate(drive).admit(records);
    benchmark::DoNotOptimize(host::identify_drive(measured, drive, method).relative_error);
  });
}
BENCHMARK_CAPTURE(whole_identification, unbiased_ls, host::IdentificationMethod::unbiased_ls)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_identification, sliding_ls, host::IdentificationMethod::sliding_ls)
    ->Unit(benchmark::kMillisecond);

}  // namespace
