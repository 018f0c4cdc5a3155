// Description of a fault: name, cause, remedy, and how the axis is stopped.
#pragma once

#include "firmware/core/axis_fault.hpp"

namespace firmware {

enum class FaultReaction : std::uint8_t {
  none,       ///< nothing to stop: the axis stays enabled
  ramp_stop,  ///< the control still works: slow down within the limits of references, then drop the enable
  /// One sensor has failed, or the loop has lost the drive, but another sensor still shows the speed: slow down with
  /// that one, then drop the enable. Without one, drop the enable at once.
  sensor_stop,
  drop_enable,  ///< the control cannot be trusted, or has lost the drive: 0 V and enable off in the same sample
};

struct FaultInfo {
  AxisFault fault = AxisFault::none;
  const char* name = nullptr;
  const char* cause = nullptr;
  const char* remedy = nullptr;
  FaultReaction reaction = FaultReaction::none;
  bool loses_position = false;  ///< counts may have been lost, so the axis is no longer homed
};

}  // namespace firmware
