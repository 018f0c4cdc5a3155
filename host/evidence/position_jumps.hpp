// Jumps of the position that the drive cannot have made.
#pragma once

#include <cstddef>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct PositionJump {
  double t_s = 0.0;   ///< of the row after the jump
  double size = 0.0;  ///< mm or m
};

struct PositionJumps {
  std::size_t wraps = 0;    ///< jumps against the motion, by a power of two of encoder steps or always by as much
  double wrap_range = 0.0;  ///< what it wraps round at, mm or m
  PositionJump first_wrap;
  std::size_t new_zeros = 0;
  PositionJump first_new_zero;
  std::size_t dropped = 0;  ///< samples that are missing or repeated, all together
  PositionJump first_drop;
  std::size_t late = 0;  ///< steps that catch up with a motion that the rows before had fallen behind
  PositionJump first_late;

  /// None that changes where the axis is: late rows do not.
  bool none() const { return wraps == 0 && new_zeros == 0 && dropped == 0; }
};

/// A jump is a step that would take several times the drive's full effort; where the model has no inertia, several
/// times what the record's steps otherwise change by. Needs a position.
PositionJumps position_jumps(const Record& record, const sim::DriveDescription& model);

}  // namespace host
