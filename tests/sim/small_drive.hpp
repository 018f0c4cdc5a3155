// A rotary drive with round numbers for tests against closed forms: one volt is one newton metre.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "sim/drive.hpp"

namespace sim_test {

inline constexpr double kInertia = 0.01;              // kg m^2
inline constexpr double kViscous = 0.05;              // Nm s/rad
inline constexpr double kRate = kViscous / kInertia;  // 1/s
inline constexpr double kCoulomb = 0.4;               // Nm
inline constexpr double kStatic = 0.7;                // Nm
inline constexpr double kOmega = 2.0;                 // rad/s
inline constexpr double kLead = 1.5;                  // mm/rad
inline constexpr double kNmPerAmpere = 0.5;           // so that 2 A/V make 1 Nm/V

inline sim::EffectEntry entry(std::string kind, std::map<std::string, double> parameters) {
  return {std::move(kind), std::move(parameters), {}, {}};
}

/// Inertia alone; `with` adds the effects under test.
inline sim::DriveDescription free_mass() {
  sim::DriveDescription drive;
  drive.data.amplifier_gain_A_per_V = 2.0;
  drive.data.torque_constant_Nm_per_A = kNmPerAmpere;
  drive.data.lead = kLead;
  drive.effects.push_back(entry("inertia", {{"J", kInertia}}));
  return drive;
}

inline sim::DriveDescription with(sim::DriveDescription drive, std::string kind,
                                  std::map<std::string, double> parameters) {
  drive.effects.push_back(entry(std::move(kind), std::move(parameters)));
  return drive;
}

inline sim::DriveDescription viscous_drive() { return with(free_mass(), "viscous", {{"B", kViscous}}); }

inline sim::DriveDescription coulomb_drive() { return with(viscous_drive(), "coulomb", {{"level", kCoulomb}}); }

inline sim::DriveDescription stribeck_drive() {
  return with(coulomb_drive(), "stribeck", {{"static", kStatic}, {"omega1", kOmega}, {"omega2", kOmega}});
}

/// The state after `steps` of `period_s` each with `u_V` held, from `start`.
inline sim::DriveState run(const sim::Drive& drive, sim::DriveState start, double u_V, int steps, double period_s,
                           double t_s = 0.0) {
  for (int k = 0; k < steps; ++k) drive.step(start, u_V, t_s + k * period_s, period_s);
  return start;
}

}  // namespace sim_test
