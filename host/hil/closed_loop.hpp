// Runs the control core on the simulated board and records it row by row.
#pragma once

#include <cstdint>

#include "firmware/core/axis.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "host/record/record.hpp"
#include "sim/plant.hpp"

namespace host {

/// One axis in closed loop with a plant made of `machine`, enabled and at rest at travel 0. Every function throws
/// Failure(device_fault) if the axis faults; travel in mm and speeds in mm/s (m, m/s for a linear drive).
class ClosedLoop {
 public:
  /// `seed` fixes the tachometer's noise. Throws Failure(bad_input) if the core rejects the parameters.
  ClosedLoop(const sim::DriveDescription& machine, const firmware::AxisParameters<float>& parameters,
             std::uint64_t seed);

  /// Sets the target speed of the reference, which is reached within the limits of the parameters.
  void jog(double speed) { axis_.jog(static_cast<float>(speed)); }

  /// Starts a move within the limits; the axis must be at rest. Throws Failure(bad_input) for an unreachable target.
  void start_move_to(double travel);

  /// Shifts the reference in one sample and ignores the limits.
  void step_reference(double distance);

  void run(double duration_s);
  void run_until_at_rest();

  /// All rows so far, with reference columns; the loop must not be used afterwards.
  Record take() { return std::move(record_); }

 private:
  void log(const firmware::AxisTelemetry<float>& seen);

  sim::DataSheet data_;
  sim::Plant plant_;
  hal::pc::SimulatedAxis board_;
  firmware::Axis<float, hal::pc::SimulatedAxis> axis_;
  Record record_;
};

/// A record without rows, with the header of a simulated machine.
Record empty_record(const sim::DriveDescription& machine);

/// Time of the next row.
double next_time(const Record& record);

}  // namespace host
