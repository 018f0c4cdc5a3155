#include "host/hil/simulated_experiment.hpp"

#include <cmath>

#include "host/hil/closed_loop.hpp"

namespace host {

sim::DriveDescription data_sheet_of(const sim::DriveDescription& machine) {
  sim::DriveDescription drive = machine;
  drive.effects.clear();
  return drive;
}

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

std::vector<double> free_run_speed(const sim::DriveDescription& model, const Record& record) {
  sim::DriveDescription noiseless = model;
  noiseless.data.tach_noise_variance = 0.0;
  return record_open_loop(noiseless, record.u_V, 0).w;
}

Record record_jogs(const sim::DriveDescription& machine, const AxisDesign& design, const std::vector<Jog>& programme,
                   std::uint64_t seed, const ReferenceLimits& limits) {
  constexpr double kRest_s = 0.2;
  ClosedLoop loop(machine, axis_parameters(machine, design, hal::pc::AxisWiring{}.tachometer_resolution, limits), seed);
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
