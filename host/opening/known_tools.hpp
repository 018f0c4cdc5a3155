// Programs whose logs give names without units, with the meaning of these names.
#pragma once

#include <vector>

#include "host/import/log_file.hpp"
#include "host/opening/channel_name.hpp"

namespace host {

/// Recognises a log of ODrive, moteus, VESC Tool, Betaflight, LinuxCNC or ROS (joint states). Adds the units and
/// meanings that this tool's channel names imply, and names the layout after the tool.
void apply_known_tools(Log& log, std::vector<ChannelName>& names);

}  // namespace host
