#include "sim/catalogue.hpp"

#include <algorithm>
#include <array>

namespace sim {

namespace effects {
// One line registers an effect: its file in sim/effects defines the record of that name.
#define AXIS_EFFECTS(EFFECT)          \
  EFFECT(inertia)                     \
  EFFECT(viscous)                     \
  EFFECT(coulomb)                     \
  EFFECT(stribeck)                    \
  EFFECT(coulomb_asymmetry)           \
  EFFECT(viscous_asymmetry)           \
  EFFECT(nonlinear_viscous)           \
  EFFECT(presliding)                  \
  EFFECT(friction_lag)                \
  EFFECT(dwell_stiction)              \
  EFFECT(position_dependent_friction) \
  EFFECT(thermal_friction_drift)      \
  EFFECT(load_dependent_friction)     \
  EFFECT(constant_torque)             \
  EFFECT(spring_torque)               \
  EFFECT(cogging)                     \
  EFFECT(external_torque)             \
  EFFECT(torque_ripple)               \
  EFFECT(compliance)                  \
  EFFECT(backlash)                    \
  EFFECT(input_delay)                 \
  EFFECT(current_loop_lag)            \
  EFFECT(current_saturation)          \
  EFFECT(voltage_limit)               \
  EFFECT(dac_dead_zone)               \
  EFFECT(dac_offset)                  \
  EFFECT(tach_gain)                   \
  EFFECT(tach_offset)                 \
  EFFECT(tach_lag)                    \
  EFFECT(tach_ripple)                 \
  EFFECT(encoder_cyclic_error)        \
  EFFECT(pitch_error)                 \
  EFFECT(thermal_growth)              \
  EFFECT(free_curve)

#define AXIS_DECLARE(NAME) extern const EffectInfo NAME;
AXIS_EFFECTS(AXIS_DECLARE)
#undef AXIS_DECLARE
}  // namespace effects

namespace {
#define AXIS_ENTRY(NAME) &effects::NAME,
constexpr std::array kCatalogue = {AXIS_EFFECTS(AXIS_ENTRY)};
#undef AXIS_ENTRY
}  // namespace

std::span<const EffectInfo* const> catalogue() { return kCatalogue; }

const EffectInfo* find_effect(std::string_view kind) {
  const auto found = std::ranges::find_if(kCatalogue, [kind](const EffectInfo* info) { return info->kind == kind; });
  return found == kCatalogue.end() ? nullptr : *found;
}

const ParameterInfo* EffectInfo::parameter(std::string_view id) const {
  const std::string_view family = periodic || curve ? family_of(id) : id;
  const auto found = std::ranges::find(parameters, family, &ParameterInfo::id);
  return found == parameters.end() ? nullptr : &*found;
}

}  // namespace sim
