// Tools whose logs have names without units, with the meaning of these names.
#pragma once

#include <vector>

#include "host/import/log_file.hpp"
#include "host/opening/channel_name.hpp"

namespace host {

/// Recognises a log of ODrive, moteus, VESC Tool, Betaflight, LinuxCNC or ROS (joint states). Adds the units and
/// meanings of the channel names of this tool, and names the layout after it.
void apply_known_tools(Log& log, std::vector<ChannelName>& names);

}  // namespace host
