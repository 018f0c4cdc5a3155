#include "host/device/capture_channels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"

namespace host {

namespace {

using firmware::Channel;

struct ChannelNames {
  Channel channel;
  std::string_view rotary, linear;
};

constexpr std::array<ChannelNames, firmware::kChannels + 1> kChannelNames{{
    {Channel::dac_code, "u_V", "u_V"},
    {Channel::counts, "x_mm", "x_m"},
    {Channel::tachometer_velocity, "w_rad_s", "v_m_s"},
    {Channel::reference, "x_ref_mm", "x_ref_m"},
    {Channel::reference_velocity, "w_ref_rad_s", "v_ref_m_s"},
    {Channel::position_error, "x_err_mm", "x_err_m"},
    {Channel::velocity_estimate, "w_hat_rad_s", "v_hat_m_s"},
    {Channel::disturbance, "d_hat_V", "d_hat_V"},
    {Channel::friction, "u_friction_V", "u_friction_V"},
    {Channel::control, "u_control_V", "u_control_V"},
    {Channel::flags, "flags", "flags"},
    {Channel::table_counts, "x2_mm", "x2_m"},
}};

std::string_view name_of(const ChannelNames& names, sim::DriveKind kind) {
  return kind == sim::DriveKind::rotary ? names.rotary : names.linear;
}

/// The number nearest to `last` whose low word is `word`.
std::int64_t extend(std::int64_t last, std::uint32_t word) {
  return last + static_cast<std::int32_t>(word - static_cast<std::uint32_t>(last));
}

}  // namespace

std::string channel_name(Channel channel, sim::DriveKind kind) {
  return std::string(name_of(kChannelNames[static_cast<std::size_t>(channel)], kind));
}

Channel channel_named(std::string_view name, sim::DriveKind kind) {
  std::vector<std::string_view> known;
  for (const ChannelNames& names : kChannelNames) {
    if (name_of(names, kind) == name) return names.channel;
    known.push_back(name_of(names, kind));
  }
  throw Failure(ExitCode::usage, fmt::format("no channel is called {}{}; there are {}", name, did_you_mean(name, known),
                                             fmt::join(known, ", ")));
}

std::vector<Channel> usual_channels(bool tachometer_fitted) {
  std::vector<Channel> channels = {Channel::dac_code, Channel::counts};
  if (tachometer_fitted) channels.push_back(Channel::tachometer_velocity);
  channels.push_back(Channel::reference);
  channels.push_back(Channel::reference_velocity);
  return channels;
}

ChannelScale::ChannelScale(const firmware::AxisValues& axis, bool fixed_point, std::int64_t counts_near,
                           double table_resolution)
    : fixed_point_(fixed_point),
      encoder_resolution_(static_cast<double>(axis.get<"drive.encoder_resolution">())),
      dac_resolution_(static_cast<double>(axis.get<"drive.dac_resolution">())),
      table_resolution_(table_resolution),
      counts_(counts_near),
      reference_(counts_near * 256) {
  const firmware::FixedUnits<float> unit(firmware::axis_parameters<float>(axis));
  length_ = static_cast<double>(unit.length);
  velocity_ = static_cast<double>(unit.velocity);
  volts_ = static_cast<double>(unit.volts);
}

double ChannelScale::scalar(std::uint32_t word, double unit) const {
  if (!fixed_point_) return static_cast<double>(std::bit_cast<float>(word));
  constexpr double kOne = 1 << 21;  // FixedPoint's fractional bits
  return static_cast<double>(static_cast<std::int32_t>(word)) / kOne * unit;
}

double ChannelScale::operator()(Channel channel, std::uint32_t word) {
  switch (channel) {
    case Channel::dac_code:
      return static_cast<double>(static_cast<std::int32_t>(word)) * dac_resolution_;
    case Channel::counts:
      counts_ = extend(counts_, word);
      return static_cast<double>(counts_) * encoder_resolution_;
    case Channel::reference:
      reference_ = extend(reference_, word);
      return static_cast<double>(reference_) / 256.0 * encoder_resolution_;
    case Channel::table_counts:
      table_ = extend(table_, word);
      return static_cast<double>(table_) * table_resolution_;
    case Channel::position_error:
      return scalar(word, length_);
    case Channel::tachometer_velocity:
    case Channel::reference_velocity:
    case Channel::velocity_estimate:
      return scalar(word, velocity_);
    case Channel::disturbance:
    case Channel::friction:
    case Channel::control:
      return scalar(word, volts_);
    case Channel::flags:
      break;
  }
  return static_cast<double>(word);
}

}  // namespace host
