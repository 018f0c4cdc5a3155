#include "host/hil/closed_loop.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

Record empty_record(const sim::DriveDescription& machine) {
  Record record;
  record.path = "simulated " + machine.name;
  record.drive = machine.name;
  record.kind = machine.data.kind;
  record.sample_period_s = machine.data.sample_period_s;
  return record;
}

double next_time(const Record& record) { return record.sample_period_s * static_cast<double>(record.size()); }

ClosedLoop::ClosedLoop(const sim::DriveDescription& machine, const firmware::AxisParameters<float>& parameters,
                       std::uint64_t seed)
    : data_(machine.data), plant_(machine, seed), board_(plant_), axis_(board_), record_(empty_record(machine)) {
  const auto error = axis_.configure(parameters);
  if (error != firmware::Refusal::none) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("the axis rejects its parameters (parameter error {})", static_cast<int>(error)));
  }
  axis_.step();
  axis_.set_home(0);
  axis_.enable();
}

void ClosedLoop::start_move_to(double travel) {
  const auto counts = static_cast<std::int64_t>(std::llround(travel / data_.encoder_resolution));
  const auto planned = axis_.plan_move_to(firmware::CountPosition::at(counts));
  if (planned.refusal != firmware::Refusal::none || !axis_.start(planned.plan)) {
    throw Failure(ExitCode::bad_input, fmt::format("the simulated axis cannot move to {:g} (plan error {})", travel,
                                                   static_cast<int>(planned.refusal)));
  }
}

void ClosedLoop::step_reference(double distance) {
  const auto increment = std::llround(distance / data_.encoder_resolution * static_cast<double>(firmware::kOneCount));
  log(axis_.step_with(increment));
}

void ClosedLoop::run(double duration_s) {
  const auto steps = static_cast<std::size_t>(std::lround(duration_s / data_.sample_period_s));
  for (std::size_t k = 0; k < steps; ++k) log(axis_.step());
}

void ClosedLoop::run_until_at_rest() {
  while (!axis_.is_at_rest()) log(axis_.step());
}

void ClosedLoop::log(const firmware::AxisTelemetry<float>& seen) {
  if (seen.fault != firmware::AxisFault::none) {
    throw Failure(ExitCode::device_fault, fmt::format("the simulated axis faulted at {:.3f} s (fault {})",
                                                      next_time(record_), static_cast<int>(seen.fault)));
  }
  record_.t_s.push_back(next_time(record_));
  record_.u_V.push_back(seen.dac_code * data_.dac_resolution_V);
  record_.x.push_back(static_cast<double>(seen.encoder_counts) * data_.encoder_resolution);
  if (const auto table = plant_.read_load_encoder()) record_.x2.push_back(*table);
  if (data_.tach_noise_variance) record_.w.push_back(static_cast<double>(seen.tachometer_velocity));
  record_.x_ref.push_back(firmware::counts_from<double>(0, seen.reference) * data_.encoder_resolution);
  record_.w_ref.push_back(static_cast<double>(seen.reference_velocity));
  plant_.advance(data_.sample_period_s);
}

}  // namespace host
