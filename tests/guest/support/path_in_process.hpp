// A G-code program on a board. On a simulated board within the test, it is the same loop without a bus.
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

struct PathInProcess {
  host::PathBoard machine;
  host::PlannedPath path;
  host::PathOutcome outcome;
  host::PathCapture capture;
};

/// The first axes of a board, with the parameters of the files; disabled before and afterwards.
inline PathInProcess follow_on(host::BoardClient& board, std::size_t axes, const std::vector<std::string>& parameters,
                               const std::string& program) {
  firmware::ParameterValues values = board.read_values();
  for (const std::string& file : parameters) host::put_file(values, file);
  board.write_values(values);
  const auto mask = static_cast<std::uint8_t>((1u << axes) - 1u);
  host::enable_and_wait(board, mask);
  PathInProcess done;
  done.machine = host::path_board(values, axes);
  host::path_start(board, done.machine.scale, true);
  host::PathPlanOptions options;
  options.limits = done.machine.limits;
  options.count_mm = done.machine.scale.count_mm.front();
  options.time_unit_s = 1.0 / done.machine.scale.rate_Hz / (1u << firmware::kPathTimeBits);
  done.path = host::plan_path(host::read_gcode(program, "program", host::PathPoint::Zero(), {}).moves, options);
  host::PathRecorder recorder(board, done.machine);
  done.outcome =
      host::run_path(board, done.path, done.machine, true, recorder, [](const auto&) { return host::PathWish{}; });
  recorder.stop();
  host::disable_and_wait(board, mask);
  done.capture = recorder.capture();
  return done;
}

/// Axes that are these drives, with the parameters of the files.
inline PathInProcess follow_in_process(const std::vector<host::SimulatedDrive>& drives,
                                       const std::vector<std::string>& parameters, const std::string& program) {
  host::BoardClient board(std::make_unique<host::SimulatedLink>(host::SimulatedDeviceOptions{drives, "", 1}));
  return follow_on(board, drives.size(), parameters, program);
}

/// Contour error, um rms, of two axes with this drive. NaN if the path does not end.
inline double contour_rms_in_process(const sim::DriveDescription& drive, const std::vector<std::string>& parameters,
                                     const std::string& program) {
  const PathInProcess done = follow_in_process({{drive}, {drive}}, parameters, program);
  if (static_cast<firmware::PathEnd>(done.outcome.state.end) != firmware::PathEnd::completed) return std::nan("");
  double squares = 0.0;
  const std::vector<double> errors = host::contour_error_um(done.capture, done.path, done.machine.scale);
  for (const double error_um : errors) squares += error_um * error_um;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

}  // namespace guest_test
