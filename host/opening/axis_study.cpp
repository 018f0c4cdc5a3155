#include "host/opening/axis_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/opening/channel_physics.hpp"
#include "host/opening/encoder_scale.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// Least correlation of a matching pair of position and speed.
constexpr double kPair = 0.95;

/// Relative error of a scale that was found from set points: the smallest value, and that of six simulated machines
/// with PI control (at most 2.3e-3, except for single sweeps).
constexpr double kScaleTolerance = 3e-4, kFollowingError = 4e-3;

bool is_angular(const ChannelName& name) { return name.unit && name.unit->dimension == Dimension::angular_speed; }

}  // namespace

double AxisStudy::rank(const NamedChannel& channel) const {
  const LogColumn& column = log_.columns[channel.column];
  if (!column.fault.empty() || is_constant(column.values)) return -1.0;
  double merit = 1.0;
  if (channel.name.is_measured) merit += 2.0;
  if (channel.name.makes_torque) merit += 2.5;
  if (channel.name.unit) merit += channel.name.unit->dimension == Dimension::share ? -0.5 : 1.0;
  if (!channel.name.is_weak) merit += 1.0;
  return merit;
}

const NamedChannel* AxisStudy::pick(ChannelQuantity quantity, bool reference, bool second) {
  const NamedChannel* best = nullptr;
  std::vector<const NamedChannel*> equal;
  for (const NamedChannel& channel : channels_) {
    if (settled_[channel.column] || channel.name.quantity != quantity || channel.name.is_reference != reference ||
        channel.name.is_second != second || rank(channel) < 0.0)
      continue;
    if (best == nullptr || rank(channel) > rank(*best)) equal.clear();
    if (best == nullptr || rank(channel) > rank(*best)) best = &channel;
    if (rank(channel) == rank(*best)) equal.push_back(&channel);
  }
  if (equal.size() < 2) return best;
  const bool is_effort =
      quantity == ChannelQuantity::current || quantity == ChannelQuantity::torque || quantity == ChannelQuantity::force;
  if (is_effort && position_ != nullptr) {
    std::ranges::sort(equal, std::ranges::greater(), [&](const NamedChannel* channel) {
      return effort_by_motion(values(*position_), values(*channel)).value_or(0.0);
    });
    constexpr double kClearly = 0.3;
    if (effort_by_motion(values(*position_), values(*equal[0])).value_or(0.0) >
        effort_by_motion(values(*position_), values(*equal[1])).value_or(0.0) + kClearly)
      return equal[0];
  }
  std::string names;
  for (const NamedChannel* channel : equal) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", quoted(*channel));
    leave(*channel, fmt::format("one of several possible channels for the {}", quantity_name(quantity)), 0.3);
  }
  ask(fmt::format("{}which is the {}: {}? Name it by --map", axis_->name.empty() ? "" : axis_->name + ": ",
                  quantity_name(quantity), names));
  lack(fmt::format("which of {} is the {}", names, quantity_name(quantity)));
  return nullptr;
}

std::string AxisStudy::quoted(const NamedChannel& channel) const {
  return fmt::format("'{}'", log_.columns[channel.column].name);
}

void AxisStudy::take(const NamedChannel& channel, Decision decision) {
  OpenedChannel& out = found_->channels[channel.column];
  settled_[channel.column] = true;
  out.axis = axis_->name;
  out.taken_as = decision.column;
  out.factor = decision.factor;
  out.offset = decision.offset;
  out.why = decision.why;
  out.sure = decision.sure;
  const LogColumn& column = log_.columns[channel.column];
  Mapping mapping{decision.column, column.name, column.time == axis_->stamps ? "" : column.time, decision.factor,
                  decision.offset};
  if (mapping.source.empty()) mapping.source = fmt::format("#{}", channel.column + 1);
  const bool is_open = may_slide_ && channel.name.sliding_unit;  // all channels of a joint share one question
  if (is_open) out.sure = std::min(out.sure, kAssumed);
  if (decision.sure < kSureEnough && !is_open)
    ask(fmt::format("{}{}: {} ({})? If not, give --map {}=…", axis_->name.empty() ? "" : axis_->name + ": ",
                    quoted(channel), mapping_text(mapping), decision.why, decision.column));
  axis_->mappings.push_back(std::move(mapping));
}

void AxisStudy::leave(const NamedChannel& channel, std::string why, double sure) {
  OpenedChannel& out = found_->channels[channel.column];
  settled_[channel.column] = true;
  out.axis = axis_->name;
  out.why = std::move(why);
  out.sure = sure;
}

double AxisStudy::lead() const {
  return hints_.sheet && hints_.sheet->kind == sim::DriveKind::rotary ? hints_.sheet->lead : 1.0;
}

bool AxisStudy::looks_rotary() const {
  if (hints_.sheet) return hints_.sheet->kind == sim::DriveKind::rotary;
  return std::ranges::none_of(channels_, [](const NamedChannel& channel) {
    return channel.name.unit && (channel.name.unit->dimension == Dimension::length ||
                                 channel.name.unit->dimension == Dimension::linear_speed ||
                                 channel.name.unit->dimension == Dimension::force);
  });
}

/// The median over several logs, because a single sweep may miss its commanded amplitudes.
std::optional<Proportion> AxisStudy::best_follow(std::size_t measured, std::size_t reference) const {
  std::vector<Proportion> all;
  for (const Log* log : group_)
    if (const auto found = follows(log->columns[measured].values, log->columns[reference].values))
      all.push_back(*found);
  if (all.empty()) return std::nullopt;
  std::ranges::sort(all, {}, &Proportion::factor);
  return all[(all.size() - 1) / 2];
}

std::optional<Proportion> AxisStudy::best_change(std::size_t position, std::size_t speed) const {
  std::optional<Proportion> best;
  for (const Log* log : group_) {
    const auto found = change_over_speed(log->columns[position].values, log->columns[speed].values, period_s_);
    if (found && (!best || found->r_squared > best->r_squared)) best = found;
  }
  return best;
}

std::optional<AxisStudy::Decision> AxisStudy::position_by_unit(const NamedChannel& channel) const {
  if (!channel.name.unit) return std::nullopt;
  const UnitMeaning unit = *channel.name.unit;
  const std::string& text = channel.name.unit_text;
  if (unit.dimension == Dimension::length)
    return Decision{"x_mm", unit.factor, unit.offset, kSureByUnit, fmt::format("position in {}", text)};
  if (unit.dimension == Dimension::angle)
    return Decision{"x_mm", unit.factor * lead(), 0.0, kSureByUnit,
                    fmt::format("angle in {}; {}", text,
                                hints_.sheet ? fmt::format("{:.6g} mm per radian from the data sheet", lead())
                                             : "1 mm stands for 1 rad")};
  if (unit.dimension == Dimension::counts && hints_.sheet && hints_.sheet->encoder_resolution > 0.0) {
    const double to_mm = hints_.sheet->kind == sim::DriveKind::rotary ? 1.0 : 1e3;
    return Decision{"x_mm", hints_.sheet->encoder_resolution * to_mm, 0.0, kSureByUnit,
                    "counts of the data sheet's encoder"};
  }
  return std::nullopt;
}

std::optional<AxisStudy::Decision> AxisStudy::scale_by_reference(const NamedChannel& channel) const {
  for (const NamedChannel& reference : channels_) {
    const auto known = reference.name.quantity == ChannelQuantity::position && reference.name.is_reference
                           ? position_by_unit(reference)
                           : std::nullopt;
    if (!known) continue;
    const auto found = best_follow(channel.column, reference.column);
    if (!found || found->r_squared < 0.999 || found->factor == 0.0) continue;
    const bool in_mm = reference.name.unit->dimension == Dimension::length;
    const double unit = reference.name.unit->factor, per_unit = found->factor / unit;
    const std::string by = fmt::format("its change against {}", quoted(reference));
    if (std::abs(per_unit * unit - 1.0) < 5e-3)
      return Decision{"x_mm", known->factor, 0.0, kSureByPhysics,
                      fmt::format("the unit of {}, which it follows", quoted(reference))};
    for (const auto& [tolerance, sure] : {std::pair{kScaleTolerance, kSureByPhysics}, std::pair{kFollowingError, 0.85}})
      if (const auto neat = in_mm ? neat_counts_per_mm(per_unit, tolerance) : neat_counts_per_rad(per_unit, tolerance))
        return Decision{
            "x_mm", (in_mm ? 1.0 : lead()) / neat->value, 0.0, sure,
            fmt::format("{} ({:.6g} per {} from {})", neat->words, per_unit, in_mm ? "millimetre" : "radian", by)};
    return Decision{"x_mm", (in_mm ? 1.0 : lead()) / per_unit, 0.0, 0.8,
                    fmt::format("{:.6g} counts per {} from {}", per_unit, in_mm ? "millimetre" : "radian", by)};
  }
  return std::nullopt;
}

std::optional<AxisStudy::Decision> AxisStudy::unit_by_speed(const NamedChannel& channel) const {
  if (speed_ == nullptr || !speed_->name.unit) return std::nullopt;
  const UnitMeaning unit = *speed_->name.unit;
  const auto found = best_change(channel.column, speed_->column);
  if (!found || found->r_squared < kPair || found->factor == 0.0) return std::nullopt;
  const double per_unit = unit.factor / found->factor;  // size of one step of the position, in rad or mm
  if (unit.dimension == Dimension::angular_speed) {
    if (const auto neat = neat_angle(per_unit))
      return Decision{"x_mm", neat->value * lead(), 0.0, kSureByPhysics,
                      fmt::format("{}, from the speed in {}", neat->words, speed_->name.unit_text)};
    if (const auto neat = neat_counts_per_rad(1.0 / per_unit, 3e-3))
      return Decision{"x_mm", lead() / neat->value, 0.0, 0.8,
                      fmt::format("{}, from the speed in {}", neat->words, speed_->name.unit_text)};
  }
  if (unit.dimension == Dimension::linear_speed)
    if (const auto neat = neat_length(per_unit))
      return Decision{"x_mm", neat->value, 0.0, kSureByPhysics,
                      fmt::format("{}, from the speed in {}", neat->words, speed_->name.unit_text)};
  return std::nullopt;
}

void AxisStudy::settle_position() {
  position_ = pick(ChannelQuantity::position, false, false);
  if (position_ == nullptr) {
    position_ = pick(ChannelQuantity::position, false, true);
    if (position_ == nullptr) return;
  }
  std::optional<Decision> decision = position_by_unit(*position_);
  if (!decision) decision = scale_by_reference(*position_);
  if (!decision) decision = unit_by_speed(*position_);
  const bool in_counts = position_->name.unit ? position_->name.unit->dimension == Dimension::counts
                                              : position_->name.unit_text.empty() && are_whole(values(*position_));
  if (!decision && in_counts) {
    leave(*position_, "position in counts; the log does not state the encoder", 0.6);
    lack(fmt::format(
        "the size of one count of {}: give the encoder's resolution by --sheet, or --map x_mm={}*MM_PER_COUNT",
        quoted(*position_), source_text(log_.columns[position_->column].name)));
    return;
  }
  if (!decision && !position_->name.unit_text.empty()) {
    leave(*position_, fmt::format("position in the unknown unit '{}'", position_->name.unit_text), 0.4);
    lack(fmt::format("the size in mm or rad of the unit '{}' of {}; give --map", position_->name.unit_text,
                     quoted(*position_)));
    return;
  }
  if (!decision)
    decision = Decision{"x_mm", looks_rotary() ? lead() : 1.0, 0.0, kAssumed,
                        looks_rotary() ? "position without a unit, taken as rad (1 mm stands for 1 rad)"
                                       : "position without a unit, taken as mm"};
  if (const auto range = wrap_range(values(*position_))) {
    axis_->unwrap.push_back({"x_mm", *range * std::abs(decision->factor)});
    decision->why += fmt::format("; wraps at {:.6g}", *range);
  }
  position_taken_ = decision;
  take(*position_, *decision);
}

/// The table's own sensor. No record needs one, so a doubtful one is left out without a question.
void AxisStudy::settle_table_position() {
  if (!position_taken_) return;
  const NamedChannel* table = nullptr;
  for (const NamedChannel& channel : channels_)
    if (!settled_[channel.column] && channel.name.quantity == ChannelQuantity::position && channel.name.is_second &&
        !channel.name.is_reference && rank(channel) >= 0.0 && (table == nullptr || rank(channel) > rank(*table)))
      table = &channel;
  if (table == nullptr) return;
  const auto found = best_follow(table->column, position_->column);
  if (!found || found->r_squared < kPair || found->factor == 0.0) {
    leave(*table, fmt::format("a second position that does not follow {}", quoted(*position_)), 0.5);
    return;
  }
  const double shown = position_taken_->factor / found->factor;  // mm per step, by the motor's position
  constexpr double kSameWay = 0.05;                              // backlash, wind-up and pitch errors are much smaller
  const auto by_unit =
      table->name.unit && table->name.unit->dimension == Dimension::length ? position_by_unit(*table) : std::nullopt;
  const auto neat = neat_length(std::abs(shown));
  const double size = by_unit ? by_unit->factor : neat ? neat->value : 0.0;
  if (!(size > 0.0) || std::abs(std::abs(shown) / size - 1.0) > kSameWay) {
    leave(*table,
          fmt::format("the table's position: its step is {:.6g} mm according to {}; give --map x2_mm={}*MM_PER_STEP",
                      shown, quoted(*position_), source_text(log_.columns[table->column].name)),
          0.6);
    return;
  }
  take(*table, {"x2_mm", std::copysign(size, shown), 0.0, by_unit ? kSureByUnit : kSureByPhysics,
                fmt::format("the table by its own sensor, {}{}", by_unit ? by_unit->why : neat->words,
                            shown < 0.0 ? ", with the opposite sign" : "")});
}

void AxisStudy::settle_speed() {
  if (speed_ == nullptr) return;
  std::optional<Proportion> change;
  if (position_ != nullptr && position_taken_) change = best_change(position_->column, speed_->column);
  if (change && change->r_squared < kPair) change.reset();
  const auto& unit = speed_->name.unit;
  if (unit && unit->dimension == Dimension::share) {
    leave(*speed_, "speed relative to a rated speed that the log does not state", 0.6);
    lack(
        fmt::format("the rated speed for {}; give --map w_rad_s={}*RATED_RAD_PER_S", quoted(*speed_), quoted(*speed_)));
    return;
  }
  const bool position_is_angle =
      position_taken_ &&
      (!position_->name.unit ? looks_rotary() : position_->name.unit->dimension != Dimension::length);
  if (unit && (is_angular(speed_->name) || unit->dimension == Dimension::linear_speed)) {
    const bool angular = is_angular(speed_->name);
    Decision decision{angular ? "w_rad_s" : "v_mm_s", unit->factor, 0.0, kSureByUnit,
                      fmt::format("speed in {}", speed_->name.unit_text)};
    const bool to_angle = !angular && hints_.sheet && hints_.sheet->kind == sim::DriveKind::rotary;
    if (to_angle)
      decision = {"w_rad_s", unit->factor / lead(), 0.0, kSureByUnit,
                  fmt::format("speed in {}, {:.6g} mm per radian from the data sheet", speed_->name.unit_text, lead())};
    if (change) {
      const double shown = change->factor * position_taken_->factor / unit->factor;  // mm per rad, or 1
      if (angular && position_->name.unit && position_->name.unit->dimension != Dimension::angle && !hints_.sheet) {
        found_->lead_mm_per_rad = std::abs(shown);
        decision.why += fmt::format("; {:.6g} mm per radian from {}", std::abs(shown), quoted(*position_));
      } else if (!to_angle && std::abs(shown / (angular ? lead() : 1.0) - 1.0) > 0.1) {
        decision.sure = kAssumed;
        decision.why +=
            fmt::format("; but {} changes {:.4g} times as fast", quoted(*position_), shown / (angular ? lead() : 1.0));
      } else {
        decision.why += fmt::format("; consistent with the change of {}", quoted(*position_));
      }
    }
    take(*speed_, decision);
    return;
  }
  if (change) {
    const double to_unit = change->factor * position_taken_->factor / (position_is_angle ? lead() : 1.0);
    const auto neat = position_is_angle ? neat_angular_speed(to_unit) : neat_linear_speed(to_unit);
    const double sure = neat ? std::min(kSureByPhysics, position_taken_->sure) : std::min(0.7, position_taken_->sure);
    take(*speed_, {position_is_angle ? "w_rad_s" : "v_mm_s", neat ? neat->value : to_unit, 0.0, sure,
                   fmt::format("{}, from the change of {}", neat ? neat->words : "speed with an unusual scale",
                               quoted(*position_))});
    return;
  }
  if (!speed_->name.unit_text.empty() || position_ != nullptr) {
    leave(*speed_,
          speed_->name.unit_text.empty()
              ? fmt::format("speed without a unit; not consistent with {}",
                            position_ ? quoted(*position_) : "the position")
              : fmt::format("speed in '{}', not confirmed by the position", speed_->name.unit_text),
          0.4);
    if (!position_taken_) lack(fmt::format("the unit of {}; give --map", quoted(*speed_)));
    return;
  }
  lack(
      fmt::format("the unit of {} (no unit in its name, no position to compare with); give --map w_rad_s=… or v_mm_s=…",
                  quoted(*speed_)));
  leave(*speed_, "speed without a unit", 0.4);
}

void AxisStudy::settle_references() {
  const NamedChannel* reference = pick(ChannelQuantity::position, true, false);
  if (reference != nullptr) {
    std::optional<Decision> decision = position_by_unit(*reference);
    if (!decision && position_taken_) {
      const auto found = best_follow(position_->column, reference->column);
      if (found && found->r_squared > 0.99 && std::abs(std::abs(found->factor) - 1.0) < 0.03)
        decision = Decision{"x_ref_mm", position_taken_->factor, 0.0, std::min(kSureByPhysics, position_taken_->sure),
                            fmt::format("{} follows it", quoted(*position_))};
    }
    if (decision) {
      decision->column = "x_ref_mm";
      take(*reference, *decision);
    } else {
      leave(*reference, "position reference in an unknown unit", 0.5);
    }
  }
  const NamedChannel* wanted = pick(ChannelQuantity::speed, true, false);
  if (wanted == nullptr) return;
  const OpenedChannel* speed = speed_ != nullptr ? &found_->channels[speed_->column] : nullptr;
  if (wanted->name.unit && (is_angular(wanted->name) || wanted->name.unit->dimension == Dimension::linear_speed)) {
    const bool angular = is_angular(wanted->name);
    take(*wanted, {angular ? "w_ref_rad_s" : "v_ref_mm_s", wanted->name.unit->factor, 0.0, kSureByUnit,
                   fmt::format("speed reference in {}", wanted->name.unit_text)});
  } else if (speed != nullptr && !speed->taken_as.empty() && wanted->name.unit_text == speed_->name.unit_text) {
    take(*wanted, {speed->taken_as == "w_rad_s" ? "w_ref_rad_s" : "v_ref_mm_s", speed->factor, 0.0,
                   std::min(0.9, speed->sure), fmt::format("speed reference, in the unit of {}", quoted(*speed_))});
  } else {
    leave(*wanted, "speed reference in an unknown unit", 0.5);
  }
}

void AxisStudy::settle_temperature() {
  if (const NamedChannel* channel = pick(ChannelQuantity::temperature, false, false)) {
    const auto& unit = channel->name.unit;
    if (unit && unit->dimension == Dimension::temperature)
      take(*channel, {"temp_C", unit->factor, unit->offset, kSureByUnit,
                      fmt::format("temperature in {}", channel->name.unit_text)});
  }
}

void AxisStudy::leave_rest() {
  for (const NamedChannel& channel : channels_) {
    if (settled_[channel.column]) continue;
    const LogColumn& column = log_.columns[channel.column];
    if (!column.fault.empty())
      leave(channel, column.fault, 0.9);
    else if (is_constant(column.values))
      leave(channel, "never changes", 0.9);
    else if (channel.name.quantity == ChannelQuantity::unknown)
      leave(channel, "not recognised; left out", 0.0);
    else
      leave(channel,
            fmt::format("{}{}; not needed", channel.name.is_reference ? "wanted " : "",
                        quantity_name(channel.name.quantity)),
            0.7);
  }
}

void AxisStudy::run(std::vector<NamedChannel> channels, OpenedAxis& axis, Understanding& found) {
  channels_ = std::move(channels);
  settled_.assign(log_.columns.size(), false);
  axis_ = &axis;
  found_ = &found;
  settle_joint();
  speed_ = pick(ChannelQuantity::speed, false, false);
  settle_position();
  settle_table_position();
  settle_speed();
  settle_references();
  settle_effort();
  settle_temperature();
  find_constants();
  ask_of_joint();
  leave_rest();
  if (effort_ == nullptr && axis_->missing.empty())
    lack("the torque or force: no current, torque, force or command voltage was logged");
  const bool moves = std::ranges::any_of(axis_->mappings, [](const Mapping& mapping) {
    return mapping.column == "x_mm" || mapping.column == "w_rad_s" || mapping.column == "v_mm_s";
  });
  if (!moves && position_ == nullptr && speed_ == nullptr) lack("the motion: no position and no speed was logged");
  axis_->makes_record = effort_ != nullptr && moves;
}

}  // namespace host
