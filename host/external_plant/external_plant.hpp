// An external program that simulates the machine, in lockstep with the board.
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

/// All its axes advance together: the first axis that advances requests the period from the program, with the present
/// commands of all axes.
class ExternalPlant {
 public:
  /// Starts the program and waits until it is ready. `period_s`: period of its lines; `patience`: time-out for an
  /// answer, longer for the first. Throws Failure with the program's last output: no_such_device (it ended), time_out,
  /// protocol (an unexpected answer). Every later exchange throws the same.
  ExternalPlant(const std::string& command, std::size_t axes, double period_s, std::chrono::milliseconds patience);

  /// One axis of the program; it keeps the program running. Throws Failure(bad_input) if the board's control period is
  /// not a multiple of the program's period.
  static std::shared_ptr<sim::ForeignMotion> axis(const std::shared_ptr<ExternalPlant>& plant, std::size_t index);

 private:
  friend class ExternalAxis;

  void run_to(std::uint64_t periods);

  PlantProgram program_;
  double period_s_;
  std::chrono::milliseconds patience_;
  std::uint64_t periods_ = 0;
  std::vector<std::optional<double>> commands_V_;
  std::vector<sim::ForeignReading> readings_;  ///< 0, at rest, before the first exchange
};

/// A drive described by its data sheet only; the program simulates its effects.
sim::DriveDescription data_sheet_alone(const sim::DriveDescription& drive);

}  // namespace host
