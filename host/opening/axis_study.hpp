// One axis of a log: finds the channels of position, speed and torque or current, and their units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/opening/channel_physics.hpp"
#include "host/opening/understanding.hpp"

namespace host {

/// Confidence in a channel: it has a name with a unit, the physics of the motion confirms it, or it is assumed.
inline constexpr double kSureByUnit = 0.97, kSureByPhysics = 0.93, kAssumed = 0.6;

/// A column of the log and the meaning of its name.
struct NamedChannel {
  std::size_t column = 0;
  ChannelName name;
};

class AxisStudy {
 public:
  AxisStudy(const std::vector<const Log*>& group, const Log& log, const OpeningHints& hints, double period_s)
      : group_(group), log_(log), hints_(hints), period_s_(period_s) {}

  /// Determines the meaning of `channels`, which belong to one axis. Writes the result to `found` and `channels_out`
  /// (one entry for each column of the log).
  void run(std::vector<NamedChannel> channels, OpenedAxis& axis, Understanding& found);

 private:
  struct Decision {
    std::string column;  ///< column of the record
    double factor = 1.0, offset = 0.0, sure = 0.0;
    std::string why;
  };

  const NamedChannel* pick(ChannelQuantity quantity, bool reference, bool second);
  double rank(const NamedChannel& channel) const;
  const std::vector<double>& values(const NamedChannel& channel) const { return log_.columns[channel.column].values; }
  std::string quoted(const NamedChannel& channel) const;
  void take(const NamedChannel& channel, Decision decision);
  void leave(const NamedChannel& channel, std::string why, double sure);
  void ask(std::string text) { found_->asks.push_back(std::move(text)); }
  void lack(std::string text) { axis_->missing.push_back(std::move(text)); }

  void settle_joint();
  void ask_of_joint();
  void settle_position();
  void settle_table_position();
  void settle_speed();
  void settle_references();
  void settle_effort();
  void settle_temperature();
  void find_constants();
  void leave_rest();
  std::optional<Decision> position_by_unit(const NamedChannel& channel) const;
  std::optional<Decision> scale_by_reference(const NamedChannel& channel) const;
  std::optional<Decision> unit_by_speed(const NamedChannel& channel) const;
  std::optional<Decision> effort_decision(const NamedChannel& channel);
  bool looks_rotary() const;
  double lead() const;
  std::optional<Proportion> best_follow(std::size_t measured, std::size_t reference) const;
  std::optional<Proportion> best_change(std::size_t position, std::size_t speed) const;

  const std::vector<const Log*>& group_;
  const Log& log_;
  const OpeningHints& hints_;
  double period_s_;
  std::vector<NamedChannel> channels_;
  std::vector<bool> settled_;
  OpenedAxis* axis_ = nullptr;
  Understanding* found_ = nullptr;
  bool may_slide_ = false;  ///< for a joint: assumed to turn, with a question to the user
  const NamedChannel *position_ = nullptr, *speed_ = nullptr, *effort_ = nullptr;
  std::optional<Decision> position_taken_;
};

}  // namespace host
