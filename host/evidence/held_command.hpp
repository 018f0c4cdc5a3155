// The command that a prediction applies: held between rows, and changed once per row, at the time at which a logged
// current acts.
#pragma once

#include <cstddef>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive.hpp"

namespace host {

class HeldCommand {
 public:
  /// Holds u_V from row to row, or the logged current with the shift of held_current. Throws as command_volts does.
  HeldCommand(const Record& record, const sim::DataSheet& data);

  /// Advances the drive from `row` to the next row.
  void step(const sim::Drive& drive, sim::DriveState& state, std::size_t row) const {
    const double t_s = (*t_s_)[row];
    if (rest_s_ <= 0.0) return drive.step(state, u_V_[row], t_s, change_s_);
    // A drive with a dead time needs steps of equal length.
    if (drive.delay_s > 0.0)
      return drive.step(state, (change_s_ * u_V_[row] + rest_s_ * u_V_[row + 1]) / (change_s_ + rest_s_), t_s,
                        change_s_ + rest_s_);
    drive.step(state, u_V_[row], t_s, change_s_);
    drive.step(state, u_V_[row + 1], t_s + change_s_, rest_s_);
  }

 private:
  const std::vector<double>* t_s_;
  std::vector<double> u_V_;
  double change_s_, rest_s_;  ///< time before and after the change within a row
};

}  // namespace host
