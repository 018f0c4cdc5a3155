#include "host/identify/simulated_experiment.hpp"

#include <fmt/format.h>

#include <cmath>

#include "firmware/core/axis.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "host/exit_codes.hpp"
#include "sim/plant.hpp"

namespace host {

namespace {

Record empty_record(const sim::DriveDescription& machine) {
  Record record;
  record.path = "simulated " + machine.name;
  record.drive = machine.name;
  record.kind = machine.data.kind;
  record.sample_period_s = machine.data.sample_period_s;
  return record;
}

double next_time(const Record& record) { return record.sample_period_s * static_cast<double>(record.size()); }

/// The control core on the simulated board, one row of the record a step.
class ClosedLoop {
 public:
  ClosedLoop(const sim::DriveDescription& machine, const AxisDesign& design, std::uint64_t seed,
             const ReferenceLimits& limits)
      : data_(machine.data), plant_(machine, seed), board_(plant_), axis_(board_), record_(empty_record(machine)) {
    const auto error =
        axis_.configure(axis_parameters(machine, design, hal::pc::AxisWiring{}.tachometer_resolution, limits));
    if (error != firmware::ParameterError::none) {
      throw Failure(ExitCode::bad_input,
                    fmt::format("the axis rejects its parameters (parameter error {})", static_cast<int>(error)));
    }
    axis_.step();
    axis_.enable();
  }

  void jog(double speed) { axis_.jog(static_cast<float>(speed)); }

  void run(double duration_s) {
    const auto steps = static_cast<std::size_t>(std::lround(duration_s / data_.sample_period_s));
    for (std::size_t k = 0; k < steps; ++k) step();
  }

  void run_until_at_rest() {
    while (!axis_.is_at_rest()) step();
  }

  Record take() { return std::move(record_); }

 private:
  void step() {
    const auto& seen = axis_.step();
    if (seen.fault != firmware::AxisFault::none) {
      throw Failure(ExitCode::device_fault, fmt::format("the simulated axis faulted at {:.3f} s (fault {})",
                                                        next_time(record_), static_cast<int>(seen.fault)));
    }
    record_.t_s.push_back(next_time(record_));
    record_.u_V.push_back(seen.dac_code * data_.dac_resolution_V);
    record_.x.push_back(static_cast<double>(seen.encoder_counts) * data_.encoder_resolution);
    if (data_.tach_noise_variance) record_.w.push_back(static_cast<double>(seen.tachometer_velocity));
    record_.x_ref.push_back(firmware::counts_from<double>(0, seen.reference) * data_.encoder_resolution);
    record_.w_ref.push_back(static_cast<double>(seen.reference_velocity));
    plant_.advance(data_.sample_period_s);
  }

  sim::DataSheet data_;
  sim::Plant plant_;
  hal::pc::SimulatedAxis board_;
  firmware::Axis<float, hal::pc::SimulatedAxis> axis_;
  Record record_;
};

}  // namespace

Record record_open_loop(const sim::DriveDescription& machine, const std::vector<double>& command, std::uint64_t seed) {
  sim::Plant plant(machine, seed);
  Record record = empty_record(machine);
  for (const double u_V : command) {
    record.t_s.push_back(next_time(record));
    record.u_V.push_back(u_V);
    record.x.push_back(static_cast<double>(plant.encoder_counts()) * machine.data.encoder_resolution);
    if (const auto speed = plant.read_tachometer()) record.w.push_back(*speed);
    plant.set_command(u_V);
    plant.advance(record.sample_period_s);
  }
  return record;
}

Record record_jogs(const sim::DriveDescription& machine, const AxisDesign& design, const std::vector<Jog>& programme,
                   std::uint64_t seed, const ReferenceLimits& limits) {
  constexpr double kRest_s = 0.2;
  ClosedLoop loop(machine, design, seed, limits);
  for (const Jog& jog : programme) {
    loop.run(kRest_s);
    loop.jog(jog.speed);
    const double ramp_s = std::abs(jog.speed) / limits.acceleration + limits.acceleration / limits.jerk;
    loop.run(ramp_s + jog.constant_s);
    loop.jog(0.0);
    loop.run_until_at_rest();
  }
  loop.run(kRest_s);
  return loop.take();
}

}  // namespace host
