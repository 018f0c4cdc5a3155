// Channels of several axes in one stream, by name: "x.u_V", "y.x_mm".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/protocol/messages.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct WatchedChannel {
  std::uint8_t axis = 0;
  firmware::Channel channel = firmware::Channel::dac_code;
  bool operator==(const WatchedChannel&) const = default;
};

/// The kind of each axis, by its lead.
std::vector<sim::DriveKind> kinds_of(const firmware::ParameterValues& values);

std::string name_of(const WatchedChannel& channel, const std::vector<sim::DriveKind>& kinds);

/// "V", "mm" …; "" for flags.
std::string unit_of(const WatchedChannel& channel, const std::vector<sim::DriveKind>& kinds);

/// Channels in the order of a row. Throws Failure(usage) for an unknown name, a name that occurs twice, none, or more
/// than a row holds.
std::vector<WatchedChannel> watched_channels(const std::vector<std::string>& names,
                                             const std::vector<sim::DriveKind>& kinds);

/// All channels of these axes, without the scale on the table.
std::vector<WatchedChannel> all_channels(std::size_t axes);

/// Eight of the first fitted axes, of two at most: command, position, position error and speed, and more of a single
/// axis. Without a fitted axis those of the first.
std::vector<WatchedChannel> usual_watch(const firmware::ParameterValues& values);

}  // namespace host
