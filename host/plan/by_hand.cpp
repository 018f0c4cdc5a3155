// Manual tests for two explanations that no motion can tell apart.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "host/plan/experiment_plan.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

struct ByHand {
  std::string_view a, b, text;
};

constexpr std::array kByHand = {
    ByHand{"constant_torque", "dac_offset",
           "Short the amplifier's input with its enable on: an offset of the converter disappears, a weight still "
           "pulls. Or measure the converter's output at command 0 with a voltmeter."},
    ByHand{"constant_torque", "coulomb_asymmetry",
           "Change the load (add a known weight, remove the counterweight, or level the axis): a constant torque "
           "changes by the same amount, the two friction levels do not."},
    ByHand{"coulomb_asymmetry", "dac_offset",
           "Short the amplifier's input with its enable on, or measure the converter's output at command 0, to find an "
           "offset of the converter; then diagnose again with dac_offset set to it."},
    ByHand{"current_loop_lag", "input_delay",
           "Put a current clamp on the motor and step the command at standstill: a delay shifts the step, a current "
           "loop rounds it."},
    ByHand{"dac_dead_zone", "load_dependent_friction",
           "Put a current clamp on the motor and give small commands at standstill: within a dead zone no current "
           "flows. Or repeat the motion with another load: load-dependent friction changes with it."},
    ByHand{
        "backlash", "compliance",
        "Put a dial gauge or a second encoder on the table, hold the motor and push the table: a gap moves freely, a "
        "spring pushes back."},
    ByHand{"backlash", "presliding",
           "Put a dial gauge on the table and turn the motor back and forth by a few micrometres: with a gap the table "
           "does not move, with presliding it follows and springs back."},
    ByHand{"compliance", "presliding",
           "Change the table's load: the resonance of a spring changes, presliding does not. Or put a second encoder "
           "on the table."},
    ByHand{"cogging", "torque_ripple",
           "Run with another load, or pull the axis by hand with the amplifier off: cogging is unchanged, ripple "
           "follows the current."},
    ByHand{
        "cogging", "encoder_cyclic_error",
        "Compare the encoder with a second scale or a laser: an error of the encoder shows there, cogging does not."},
    ByHand{"constant_torque", "spring_torque",
           "Move the axis in another part of its travel, or disconnect cable chain and bellows: a spring torque "
           "depends on position."},
    ByHand{"tach_gain", "torque_ripple",
           "Compare the tachometer with the encoder over a long travel at constant speed."},
};

std::string own_advice(const std::vector<std::string>& kinds) {
  const sim::EffectInfo* info = kinds.empty() ? nullptr : sim::find_effect(kinds.back());
  return info == nullptr ? std::string() : std::string(info->separate_by);
}

}  // namespace

std::string separation_by_hand(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  if (a.size() == 1 && b.size() == 1) {
    const auto known = std::ranges::find_if(kByHand, [&](const ByHand& entry) {
      return (entry.a == a.front() && entry.b == b.front()) || (entry.a == b.front() && entry.b == a.front());
    });
    if (known != kByHand.end()) return fmt::format("{} or {}: {}", a.front(), b.front(), known->text);
  }
  return fmt::format("{} or {}: no motion in this box separates them. {}: {}. {}: {}.", rival_name(a), rival_name(b),
                     rival_name(a), own_advice(a), rival_name(b), own_advice(b));
}

}  // namespace host
