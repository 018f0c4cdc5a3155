// The control core on the simulated board, recorded row by row.
#pragma once

#include <cstdint>

#include "firmware/core/axis.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "host/record/record.hpp"
#include "sim/plant.hpp"

namespace host {

/// One axis in closed loop on a plant made of `machine`, enabled and standing at travel 0. Every function throws
/// Failure(device_fault) when the axis faults; travel and speeds are mm, mm/s (m, m/s for a linear drive).
class ClosedLoop {
 public:
  /// `seed` fixes the tachometer's noise. Throws Failure(bad_input) when the core rejects the parameters.
  ClosedLoop(const sim::DriveDescription& machine, const firmware::AxisParameters<float>& parameters,
             std::uint64_t seed);

  /// Speed reference from now on, reached within the limits of the parameters.
  void jog(double speed) { axis_.jog(static_cast<float>(speed)); }

  /// Starts a move within the limits; the axis must be at rest. Throws Failure(bad_input) for an unreachable target.
  void start_move_to(double travel);

  /// Shifts the reference at once, in one sample, limits or not.
  void step_reference(double distance);

  void run(double duration_s);
  void run_until_at_rest();

  /// Everything so far, with reference columns; the loop is of no use afterwards.
  Record take() { return std::move(record_); }

 private:
  void log(const firmware::AxisTelemetry<float>& seen);

  sim::DataSheet data_;
  sim::Plant plant_;
  hal::pc::SimulatedAxis board_;
  firmware::Axis<float, hal::pc::SimulatedAxis> axis_;
  Record record_;
};

/// A record without rows, headed as recorded on a simulated machine.
Record empty_record(const sim::DriveDescription& machine);

/// Time of the row that is to be added next.
double next_time(const Record& record);

}  // namespace host
