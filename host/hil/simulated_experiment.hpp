// Experiments on a simulated machine, recorded as on a board.
#pragma once

#include <cstdint>
#include <vector>

#include "host/identify/axis_design.hpp"
#include "host/identify/excitation.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// The data sheet of a machine, without effects, as known before identification.
sim::DriveDescription data_sheet_of(const sim::DriveDescription& machine);

/// Open loop: holds each value of `command` (V) for one sample period on a plant made of `machine`. `seed` fixes the
/// tachometer's noise.
Record record_open_loop(const sim::DriveDescription& machine, const std::vector<double>& command, std::uint64_t seed);

/// Speed of a model with the record's commands, rad/s (m/s), simulated from rest to the end without restart.
std::vector<double> free_run_speed(const sim::DriveDescription& model, const Record& record);

/// Closed loop: the control core with `design` (from the assumed model of the machine) jogs a plant made of `machine`
/// through the programme, without friction feed-forward or disturbance cancellation, as in section 3.2. Between jogs
/// the axis rests for 0.2 s. The record has reference columns. Throws Failure(bad_input) if the core rejects the
/// parameters, Failure(device_fault) if the axis faults.
Record record_jogs(const sim::DriveDescription& machine, const AxisDesign& design, const std::vector<Jog>& programme,
                   std::uint64_t seed, const ReferenceLimits& limits = {});

}  // namespace host
