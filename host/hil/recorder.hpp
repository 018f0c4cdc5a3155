// Rows of a machine's run: one record an axis, as a board would log them.
#pragma once

#include <array>
#include <vector>

#include "host/hil/machine.hpp"
#include "host/record/record.hpp"

namespace host {

class Recorder {
 public:
  explicit Recorder(const Machine& machine);

  /// The control period that has just run.
  void take();

  std::size_t size() const { return records_[0].size(); }
  const Record& record(std::size_t axis) const { return records_[axis]; }
  /// Reference less encoder, µm; the encoder's step is taken at its middle.
  std::vector<double> tracking_error_um(std::size_t axis) const;

 private:
  const Machine& machine_;
  std::array<Record, hal::kAxisCount> records_;
};

}  // namespace host
