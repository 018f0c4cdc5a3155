// Common parts of the effects of a second mass.
#pragma once

#include <string_view>

#include "sim/coupling.hpp"
#include "sim/drive_description.hpp"
#include "sim/effect.hpp"

namespace sim {

/// Whether an effect puts a second mass behind the motor.
inline bool is_second_mass(std::string_view kind) { return kind == "compliance" || kind == "backlash"; }

/// From an entry of compliance or backlash. Unless the entry says otherwise, all friction acts on the load's side, and
/// viscous friction has the same share as dry friction.
inline SecondMass second_mass_of(const EffectEntry& entry) {
  const auto given = [&](const char* id, double otherwise) { return entry.has(id) ? entry.at(id) : otherwise; };
  const double dry = given("load_friction", 1.0);
  return {entry.at("load_fraction"), entry.at("resonance"), entry.at("damping_ratio"), given("gap", 0.0), dry,
          given("load_viscous", dry)};
}

inline ParameterInfo load_friction_parameter() {
  return {.id = "load_friction",
          .rotary_key = "load_friction",
          .linear_key = "load_friction",
          .doc = "p: part of the friction that acts on the load's side; 1 unless given",
          .lower = 0.0,
          .upper = 1.0,
          .starts = {0.5, 0.0},
          .optional = true,
          .absent_at_upper = true};
}

inline ParameterInfo load_viscous_parameter() {
  return {.id = "load_viscous",
          .rotary_key = "load_viscous",
          .linear_key = "load_viscous",
          .doc = "q: part of the viscous friction that acts on the load's side; load_friction unless given",
          .lower = 0.0,
          .upper = 1.0,
          .starts = {0.2},
          .optional = true,
          .absent_at_upper = true};
}

}  // namespace sim
