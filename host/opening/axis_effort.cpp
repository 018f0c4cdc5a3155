// The channel of torque or current of one axis of a log, and the properties of the drive that it shows together with
// the motion.
#include <fmt/format.h>

#include <algorithm>

#include "host/opening/axis_study.hpp"

namespace host {

std::optional<AxisStudy::Decision> AxisStudy::effort_decision(const NamedChannel& channel) {
  const auto& unit = channel.name.unit;
  const bool wanted = channel.name.is_reference;
  const double constant = hints_.torque_constant.value_or(hints_.sheet ? hints_.sheet->torque_constant_Nm_per_A : 1.0);
  const std::string said = wanted ? ", the controller's set point" : "";
  const double less = wanted ? 0.15 : 0.0;
  if (unit && unit->dimension == Dimension::share) {
    leave(channel,
          fmt::format("{} relative to a rated value that the log does not state", quantity_name(channel.name.quantity)),
          0.6);
    lack(fmt::format("the value of 100 % of {}; give --map i_A={}*AMPERES_PER_PERCENT", quoted(channel),
                     quoted(channel)));
    return std::nullopt;
  }
  if (channel.name.quantity == ChannelQuantity::voltage) {
    const bool is_V = unit && unit->dimension == Dimension::voltage;
    return Decision{"u_V", is_V ? unit->factor : 1.0, 0.0, is_V && wanted ? 0.92 : 0.7,
                    is_V ? fmt::format("voltage in {}, taken as the command to the amplifier", channel.name.unit_text)
                         : "taken as the command to the amplifier, in V"};
  }
  if (channel.name.quantity == ChannelQuantity::current || (unit && unit->dimension == Dimension::current)) {
    if (unit && unit->dimension == Dimension::current)
      return Decision{"i_A", unit->factor, 0.0, kSureByUnit - less,
                      fmt::format("current in {}{}", channel.name.unit_text, said)};
    if (unit || !channel.name.unit_text.empty()) {
      leave(channel, fmt::format("current in '{}'", channel.name.unit_text), 0.4);
      lack(fmt::format("the size in amperes of one '{}' of {}; give --map", channel.name.unit_text, quoted(channel)));
      return std::nullopt;
    }
    return Decision{"i_A", 1.0, 0.0, 0.75 - less, fmt::format("current without a unit, taken as A{}", said)};
  }
  const bool has_unit = unit && (unit->dimension == Dimension::torque || unit->dimension == Dimension::force);
  if (!has_unit && !channel.name.unit_text.empty()) {
    leave(channel,
          fmt::format("{} in '{}': the sensor's scale is not in the log", quantity_name(channel.name.quantity),
                      channel.name.unit_text),
          0.5);
    lack(fmt::format("the size in {} of one '{}' of {}; give --map i_A=…",
                     channel.name.quantity == ChannelQuantity::force ? "N" : "Nm", channel.name.unit_text,
                     quoted(channel)));
    return std::nullopt;
  }
  const bool has_constant = constant > 0.0 && constant != 1.0;
  return Decision{
      "i_A", (has_unit ? unit->factor : 1.0) / (has_constant ? constant : 1.0), 0.0, (has_unit ? 0.95 : 0.7) - less,
      fmt::format("{} {}{}; {}", quantity_name(channel.name.quantity),
                  has_unit ? "in " + channel.name.unit_text
                           : (channel.name.quantity == ChannelQuantity::force ? "without a unit, taken as N"
                                                                              : "without a unit, taken as Nm"),
                  said,
                  has_constant ? fmt::format("{:.6g} a current of 1 A", constant)
                               : (channel.name.quantity == ChannelQuantity::force ? "1 A stands for 1 N"
                                                                                  : "1 A stands for 1 Nm"))};
}

void AxisStudy::settle_effort() {
  for (const bool wanted : {false, true})
    for (const ChannelQuantity quantity : {ChannelQuantity::current, ChannelQuantity::torque, ChannelQuantity::force}) {
      const NamedChannel* channel = pick(quantity, wanted, false);
      if (channel == nullptr) continue;
      if (const auto decision = effort_decision(*channel)) {
        take(*channel, *decision);
        effort_ = channel;
        return;
      }
    }
  for (const bool wanted : {true, false})
    if (const NamedChannel* channel = pick(ChannelQuantity::voltage, wanted, false))
      if (const auto decision = effort_decision(*channel)) {
        take(*channel, *decision);
        effort_ = channel;
        return;
      }
}

void AxisStudy::find_constants() {
  const auto taken = [this](const NamedChannel* channel) {
    std::vector<double> scaled;
    if (channel == nullptr || found_->channels[channel->column].taken_as.empty()) return scaled;
    scaled = values(*channel);
    for (double& value : scaled)
      value = value * found_->channels[channel->column].factor + found_->channels[channel->column].offset;
    return scaled;
  };
  LoggedMotion logged{taken(position_), taken(speed_), false, {}, {}};
  if (speed_ != nullptr && found_->channels[speed_->column].taken_as == "v_mm_s") {
    logged.is_linear = true;
    for (double& speed : logged.speed) speed *= 1e-3;
  }
  if (effort_ != nullptr && effort_->name.quantity == ChannelQuantity::current) logged.current = taken(effort_);
  for (const NamedChannel& channel : channels_) {
    const auto& unit = channel.name.unit;
    if (settled_[channel.column] || channel.name.quantity != ChannelQuantity::voltage || rank(channel) < 0.0) continue;
    logged.voltages.push_back(values(channel));
    for (double& voltage : logged.voltages.back())
      voltage *= unit && unit->dimension == Dimension::voltage ? unit->factor : 1.0;
  }
  axis_->constants = constants_of(logged);
}

}  // namespace host
