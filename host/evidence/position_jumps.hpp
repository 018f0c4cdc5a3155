// Finds jumps of the position that the drive cannot have made.
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
  std::size_t wraps =
      0;  ///< jumps against the motion, by a power of two of encoder steps or always by the same distance
  double wrap_range = 0.0;  ///< range at which it wraps, mm or m
  PositionJump first_wrap;
  std::size_t new_zeros = 0;
  PositionJump first_new_zero;
  std::size_t dropped = 0;  ///< missing or repeated samples in total
  PositionJump first_drop;
  std::size_t late = 0;  ///< steps that catch up after held rows
  PositionJump first_late;

  /// Whether no jump changes the position; late rows do not count.
  bool none() const { return wraps == 0 && new_zeros == 0 && dropped == 0; }
};

/// A jump is a step that would need several times the drive's full torque or force; if the model has no inertia,
/// several times the usual change between the record's steps. Needs a position.
PositionJumps position_jumps(const Record& record, const sim::DriveDescription& model);

}  // namespace host
