// The gains from command to torque: Ka from the motor current (Erkorkmaz & Altintas 2001, p. 1499), and Kt*Ka from a
// known inertia.
#pragma once

#include <optional>
#include <vector>

#include "host/identify/rigid_estimate.hpp"
#include "host/record/record.hpp"

namespace host {

/// Gain of a current amplifier, from records with command and current.
struct AmplifierGain {
  Estimate gain;  ///< Ka, A/V, for a constant command, so without dead time and current loop
  double offset_A = 0.0;
  double relative_residual = 0.0;  ///< norm of the part of the current that the command does not explain
};

/// Regression of the current on the command and its last five changes. Rows with the command at the converter's limit
/// are left out. Empty if a record lacks command or current, or if the current does not follow the command (if less
/// than 90 % of the norm is explained, the command is the voltage of a winding, or the amplifier limits the current).
std::optional<AmplifierGain> amplifier_gain(const std::vector<Record>& records, double dac_limit_V);

/// Torque per command from an added inertia. If the gain is larger than assumed, the identified inertia grows by less
/// than the added inertia.
struct GainCheck {
  double added = 0.0;                 ///< inertia, kg m^2 (kg)
  double grown = 0.0;                 ///< growth of the inertia identified with the assumed gain
  Estimate factor;                    ///< true gain over the assumed one
  Estimate inertia;                   ///< inertia of the drive without the added one, by the true gain
  double assumed = 0.0, found = 0.0;  ///< Kt*Ka, Nm/V (N/V); Kt, Nm/A (N/A), if only the current was logged
};

/// Throws Failure(refused) if the added inertia is not larger than the intervals of both estimates.
GainCheck check_gain(const Estimate& bare, const Estimate& loaded, double added, double assumed);

}  // namespace host
