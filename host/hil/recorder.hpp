// Records a machine's run as a board does: one record per axis.
#pragma once

#include <array>
#include <vector>

#include "host/hil/machine.hpp"
#include "host/record/record.hpp"

namespace host {

class Recorder {
 public:
  explicit Recorder(const Machine& machine);

  /// Records the control period that has just ended.
  void take();

  std::size_t size() const { return records_[0].size(); }
  const Record& record(std::size_t axis) const { return records_[axis]; }
  /// Reference minus encoder, µm; an encoder count is taken at the middle of its step.
  std::vector<double> tracking_error_um(std::size_t axis) const;

 private:
  const Machine& machine_;
  std::array<Record, hal::kAxisCount> records_;
};

}  // namespace host
