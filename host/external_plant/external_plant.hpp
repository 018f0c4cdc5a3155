// A machine that is another program, in lockstep with the board that controls it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/external_plant/plant_answer.hpp"
#include "host/external_plant/plant_program.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// All axes of it advance together: the first one to do so asks the program for the period, with the commands that all
/// of them have by then.
class ExternalPlant {
 public:
  /// Starts the program and waits until it is ready. `period_s`: of its lines; `patience`: for an answer, more for the
  /// first. Throws Failure: no_such_device (it ends), time_out, protocol (any other answer than expected), each with
  /// what it last said. Every later exchange throws the same.
  ExternalPlant(const std::string& command, std::size_t axes, double period_s, std::chrono::milliseconds patience);

  /// One of its axes, which keeps the program alive. A board whose control period is no whole number of the program's
  /// periods gets Failure(bad_input).
  static std::shared_ptr<sim::ForeignMotion> axis(const std::shared_ptr<ExternalPlant>& plant, std::size_t index);

 private:
  friend class ExternalAxis;

  void run_to(std::uint64_t periods);

  PlantProgram program_;
  double period_s_;
  std::chrono::milliseconds patience_;
  std::uint64_t periods_ = 0;
  std::vector<std::optional<double>> commands_V_;
  std::vector<sim::ForeignReading> readings_;  ///< standing at 0 before the first exchange
};

/// A drive of which nothing but the data sheet is known; its effects are the program's.
sim::DriveDescription data_sheet_alone(const sim::DriveDescription& drive);

}  // namespace host
