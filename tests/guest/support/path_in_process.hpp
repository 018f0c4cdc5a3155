// A G-code program on a simulated board within the test: the same loop without a bus.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "firmware/core/path/path_follower.hpp"
#include "host/device/motion.hpp"
#include "host/device/path_run.hpp"
#include "host/gcode/program.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/simulated_board/simulated_link.hpp"

namespace guest_test {

/// Contour error, um rms, of two axes that are this drive, with the parameters of the files. NaN where it does not end.
inline double contour_rms_in_process(const sim::DriveDescription& drive, const std::vector<std::string>& parameters,
                                     const std::string& program) {
  constexpr std::size_t kAxes = 2;
  host::BoardClient board(std::make_unique<host::SimulatedLink>(
      host::SimulatedDeviceOptions{std::vector<host::SimulatedDrive>(kAxes, {drive}), "", 1}));
  firmware::ParameterValues values = board.read_values();
  for (const std::string& file : parameters) host::put_file(values, file);
  board.write_values(values);
  host::enable_and_wait(board, (1u << kAxes) - 1u);
  const host::PathBoard machine = host::path_board(values, kAxes);
  host::path_start(board, machine.scale, true);
  host::PathPlanOptions options;
  options.limits = machine.limits;
  options.count_mm = machine.scale.count_mm.front();
  options.time_unit_s = 1.0 / machine.scale.rate_Hz / (1u << firmware::kPathTimeBits);
  const host::PlannedPath path =
      host::plan_path(host::read_gcode(program, "program", host::PathPoint::Zero(), {}).moves, options);
  host::PathRecorder recorder(board, machine);
  const host::PathOutcome outcome =
      host::run_path(board, path, machine, true, recorder, [](const auto&) { return host::PathWish{}; });
  recorder.stop();
  if (static_cast<firmware::PathEnd>(outcome.state.end) != firmware::PathEnd::completed) return std::nan("");
  double squares = 0.0;
  const std::vector<double> errors = host::contour_error_um(recorder.capture(), path, machine.scale);
  for (const double error_um : errors) squares += error_um * error_um;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

}  // namespace guest_test
