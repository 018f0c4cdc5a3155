// The part of a model that other programs support: a friction curve over speed, and torques over the travel.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/drive.hpp"
#include "sim/harmonic.hpp"

namespace host {

/// `nonlinear_viscous`: coefficient (speed/reference)^exponent, or -coefficient exp(-speed/saturation).
struct FrictionBend {
  double coefficient = 0.0, exponent = 1.0, reference = 1.0;
  std::optional<double> saturation{};
};

struct PeriodicTorque {
  double period = 1.0;  ///< mm or m
  std::vector<sim::HarmonicTerm> orders;
};

struct PortableModel {
  std::string name;
  sim::DataSheet data;
  double inertia = 0.0;
  std::array<sim::SlidingCurve, 2> friction{};  ///< forward, backward; magnitudes
  std::optional<FrictionBend> bend;
  double constant = 0.0;  ///< added to the motor's effort, Nm or N
  std::vector<PeriodicTorque> cogging;
  double stiffness = 0.0, centre = 0.0;  ///< spring_torque: -stiffness (x - centre)

  bool rotary() const { return data.kind == sim::DriveKind::rotary; }
  /// Friction at a speed, with the sign of the speed; 0 at rest.
  double friction_at(double speed) const;
  double slope_at(double speed) const;
  /// Torque or force on the motor at a travel in mm or m, without friction.
  double load_at(double x) const;
};

/// The effects that every program with formulas can express.
const std::set<std::string>& portable_kinds();

PortableModel portable(const sim::DriveDescription& model);

}  // namespace host
