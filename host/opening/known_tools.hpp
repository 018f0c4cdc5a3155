// Programs whose logs give names without units, with the meaning of these names.
#pragma once

#include <vector>

#include "host/import/log_file.hpp"
#include "host/opening/channel_name.hpp"

namespace host {

/// Completes what names say where the log is one of ODrive's, moteus', VESC Tool's, Betaflight's or LinuxCNC's, or
/// joint states of ROS; and names the layout after the tool.
void apply_known_tools(Log& log, std::vector<ChannelName>& names);

}  // namespace host
