#include "host/identify/friction_law.hpp"

#include <cmath>

namespace host {

namespace {

double exp_or_zero(double v, double omega) { return omega > 0.0 ? std::exp(-v / omega) : 0.0; }

/// Magnitude of a value in one direction: `both` if the entry has it, else `per_direction`.
double magnitude(const sim::EffectEntry& entry, const char* both, const char* per_direction) {
  if (entry.has(both)) return std::abs(entry.at(both));
  return entry.has(per_direction) ? std::abs(entry.at(per_direction)) : 0.0;
}

}  // namespace

double FrictionSideLaw::at(double v) const {
  return static_level * exp_or_zero(v, omega1) + coulomb * (1.0 - exp_or_zero(v, omega2));
}

double FrictionLaw::effort(double speed) const {
  if (speed == 0.0) return 0.0;
  const double level = speed > 0.0 ? positive.at(speed) : -negative.at(-speed);
  return level + viscous * speed;
}

FrictionLaw friction_law(const sim::DriveDescription& model) {
  FrictionLaw law;
  if (const sim::EffectEntry* viscous = model.find("viscous"); viscous != nullptr && viscous->has("B")) {
    law.viscous = viscous->at("B");
  }
  if (const sim::EffectEntry* coulomb = model.find("coulomb")) {
    law.positive.coulomb = law.positive.static_level = magnitude(*coulomb, "level", "positive");
    law.negative.coulomb = law.negative.static_level = magnitude(*coulomb, "level", "negative");
  }
  if (const sim::EffectEntry* stribeck = model.find("stribeck")) {
    law.positive.static_level = magnitude(*stribeck, "static", "static_positive");
    law.negative.static_level = magnitude(*stribeck, "static", "static_negative");
    law.positive.omega1 = magnitude(*stribeck, "omega1", "omega1_positive");
    law.negative.omega1 = magnitude(*stribeck, "omega1", "omega1_negative");
    law.positive.omega2 = magnitude(*stribeck, "omega2", "omega2_positive");
    law.negative.omega2 = magnitude(*stribeck, "omega2", "omega2_negative");
  }
  return law;
}

bool is_symmetric(const sim::DriveDescription& model) {
  const sim::EffectEntry* coulomb = model.find("coulomb");
  return coulomb != nullptr && coulomb->has("level");
}

}  // namespace host
