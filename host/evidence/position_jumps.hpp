// Finds jumps of the position that the motion of the drive cannot explain.
#pragma once

#include <cstddef>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct PositionJump {
  double t_s = 0.0;   ///< time of the row after the jump
  double size = 0.0;  ///< mm or m
};

struct PositionJumps {
  std::size_t wraps = 0;    ///< jumps against the motion, by 2^n encoder steps or always by the same distance
  double wrap_range = 0.0;  ///< range at which the position wraps, mm or m
  PositionJump first_wrap;
  std::size_t new_zeros = 0;
  PositionJump first_new_zero;
  std::size_t dropped = 0;  ///< missing or repeated samples in total
  PositionJump first_drop;
  std::size_t late = 0;  ///< steps that catch up after rows that repeat a reading
  PositionJump first_late;

  /// Whether no jump changes the position. Late rows do not count.
  bool none() const { return wraps == 0 && new_zeros == 0 && dropped == 0; }
};

/// Finds steps that would need several times the drive's full torque or force; if the model has no inertia, steps that
/// exceed the usual change between the record's steps several times. Needs a position.
PositionJumps position_jumps(const Record& record, const sim::DriveDescription& model);

}  // namespace host
