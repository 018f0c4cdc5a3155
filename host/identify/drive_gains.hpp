// The gains that turn a command into torque: Ka from the motor current (Erkorkmaz & Altintas 2001, p. 1499), Kt*Ka from
// an inertia that is known.
#pragma once

#include <optional>
#include <vector>

#include "host/identify/rigid_estimate.hpp"
#include "host/record/record.hpp"

namespace host {

/// Of a current amplifier, from records with command and current.
struct AmplifierGain {
  Estimate gain;  ///< Ka, A/V, at standstill of the command: dead time and current loop do not matter
  double offset_A = 0.0;
  double relative_residual = 0.0;  ///< norm of what the command does not explain of the current
};

/// Regression of the current on the command and its last five changes. Rows with the command at the converter's limit
/// do not count. Empty if a record lacks either, or if the current does not follow the command (it explains less than
/// 90 % of the norm: the volts are a winding's, or the amplifier limits).
std::optional<AmplifierGain> amplifier_gain(const std::vector<Record>& records, double dac_limit_V);

/// Torque per command from an added inertia: the identified inertia grows by less than the added one where the gain is
/// larger than assumed.
struct GainCheck {
  double added = 0.0;                 ///< inertia, kg m^2 (kg)
  double grown = 0.0;                 ///< the same, as identified with the assumed gain
  Estimate factor;                    ///< true gain over the assumed one
  Estimate inertia;                   ///< of the drive without the added one, by the true gain
  double assumed = 0.0, found = 0.0;  ///< Kt*Ka, Nm/V (N/V); Kt, Nm/A (N/A), where only the current was logged
};

/// Throws Failure(refused) if the added inertia is not above the intervals of both estimates.
GainCheck check_gain(const Estimate& bare, const Estimate& loaded, double added, double assumed);

}  // namespace host
