// The channels of a capture by name, and the conversion of a board's words to physical units.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/protocol/messages.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Names, as in the columns of records: "u_V", "x_mm" ("x_m"), "w_rad_s" ("v_m_s") …
std::string channel_name(firmware::Channel channel, sim::DriveKind kind);

/// Throws Failure(usage) listing the known names.
firmware::Channel channel_named(std::string_view name, sim::DriveKind kind);

/// The default channels: command, position, speed, and their references.
std::vector<firmware::Channel> usual_channels(bool tachometer_fitted);

/// Turns words into V, mm (m), rad/s (m/s). Positions are extended from their low words, so rows must be given in
/// order.
class ChannelScale {
 public:
  /// `axis`: the board's parameters; `counts_near`: approximate encoder counts at the first row; `table_resolution`:
  /// resolution of the scale on the table, mm (m), if there is one.
  ChannelScale(const firmware::AxisValues& axis, bool fixed_point, std::int64_t counts_near,
               double table_resolution = 0.0);

  double operator()(firmware::Channel channel, std::uint32_t word);

 private:
  double scalar(std::uint32_t word, double unit) const;

  bool fixed_point_;
  double length_, velocity_, volts_;  ///< units of a fixed-point board's scalars
  double encoder_resolution_, dac_resolution_, table_resolution_;
  std::int64_t table_ = 0;
  std::int64_t counts_, reference_;  ///< latest values; the reference in 1/256 counts
};

}  // namespace host
