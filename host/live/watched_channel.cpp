#include "host/live/watched_channel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "host/device/board_report.hpp"
#include "host/device/capture_channels.hpp"
#include "host/exit_codes.hpp"

namespace host {

using firmware::Channel;

std::vector<sim::DriveKind> kinds_of(const firmware::ParameterValues& values) {
  std::vector<sim::DriveKind> kinds;
  for (std::size_t axis = 0; axis < values.axes(); ++axis)
    kinds.push_back(is_linear(axis, values) ? sim::DriveKind::linear : sim::DriveKind::rotary);
  return kinds;
}

std::string name_of(const WatchedChannel& channel, const std::vector<sim::DriveKind>& kinds) {
  return fmt::format("{}.{}", firmware::kAxisNames.at(channel.axis),
                     channel_name(channel.channel, kinds.at(channel.axis)));
}

std::string unit_of(const WatchedChannel& channel, const std::vector<sim::DriveKind>& kinds) {
  const bool is_rotary = kinds.at(channel.axis) == sim::DriveKind::rotary;
  switch (channel.channel) {
    case Channel::counts:
    case Channel::reference:
    case Channel::position_error:
    case Channel::table_counts:
      return is_rotary ? "mm" : "m";
    case Channel::tachometer_velocity:
    case Channel::reference_velocity:
    case Channel::velocity_estimate:
      return is_rotary ? "rad/s" : "m/s";
    case Channel::flags:
      return "";
    default:
      return "V";
  }
}

std::vector<WatchedChannel> watched_channels(const std::vector<std::string>& names,
                                             const std::vector<sim::DriveKind>& kinds) {
  std::vector<WatchedChannel> channels;
  const std::vector<WatchedChannel> all = all_channels(kinds.size());
  for (const std::string& name : names) {
    const auto known = std::ranges::find(all, name, [&](const WatchedChannel& one) { return name_of(one, kinds); });
    if (known == all.end()) throw Failure(ExitCode::usage, fmt::format("{}: the board has no such channel", name));
    if (std::ranges::find(channels, *known) != channels.end())
      throw Failure(ExitCode::usage, fmt::format("{}: given twice", name));
    channels.push_back(*known);
  }
  if (channels.empty() || channels.size() > firmware::kWordsPerReport)
    throw Failure(ExitCode::usage, fmt::format("choose 1 to {} channels", firmware::kWordsPerReport));
  std::ranges::sort(channels, {}, [](const WatchedChannel& one) { return std::tuple(one.axis, one.channel); });
  return channels;
}

std::vector<WatchedChannel> all_channels(std::size_t axes) {
  std::vector<WatchedChannel> channels;
  for (std::uint8_t axis = 0; axis < axes; ++axis)
    for (std::uint8_t bit = 0; bit < firmware::kChannels; ++bit) channels.push_back({axis, static_cast<Channel>(bit)});
  return channels;
}

std::vector<WatchedChannel> usual_watch(const firmware::ParameterValues& values) {
  constexpr std::size_t kMostAxes = 2, kUsual = 8;
  std::vector<std::uint8_t> axes;
  for (std::uint8_t axis = 0; axis < values.axes() && axes.size() < kMostAxes; ++axis)
    if (values.axis(axis).get<"drive.fitted">()) axes.push_back(axis);
  if (axes.empty()) axes.push_back(0);
  std::vector<WatchedChannel> channels;
  for (const std::uint8_t axis : axes) {
    std::vector<Channel> wanted{Channel::dac_code, Channel::counts, Channel::position_error};
    if (values.axis(axis).get<"tachometer.fitted">()) wanted.push_back(Channel::tachometer_velocity);
    for (const Channel further : {Channel::velocity_estimate, Channel::reference, Channel::reference_velocity,
                                  Channel::disturbance, Channel::friction})
      wanted.push_back(further);
    wanted.resize(kUsual / axes.size());
    std::ranges::sort(wanted);
    for (const Channel one : wanted) channels.push_back({axis, one});
  }
  return channels;
}

}  // namespace host
