// Data-sheet values that a log shows: the encoder's step, the current's noise, the amplifier's gain, the winding.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace host {

/// Channels of one axis in the units of a record, with one element per sample; empty if the log has none.
struct LoggedMotion {
  std::vector<double> position;  ///< mm
  std::vector<double> speed;     ///< of the motor, rad/s, or m/s if linear
  bool is_linear = false;
  std::vector<double> current;                ///< A
  std::vector<std::vector<double>> voltages;  ///< V, commanded, at the winding, or of a supply
};

struct DriveConstants {
  std::optional<double> encoder_step_mm;  ///< all positions are multiples of this step
  std::optional<double> current_noise_A;  ///< standard deviation at rest
  /// The current is proportional to the voltage, which is then the command of an amplifier: A/V (Ka of the paper, p.
  /// 1499).
  std::optional<double> amplifier_gain_A_per_V;
  /// The voltage is that of a winding: its resistance, and its back-EMF constant in V s/rad or V s/m. For a DC motor
  /// the motor constant in Nm/A or N/A is the same number.
  std::optional<double> resistance_Ohm, back_emf_V_s;
  bool is_linear = false;
};

/// The values that the channels determine; ambiguous ones are left out. If there are several voltages, uses the first
/// one that determines the current.
DriveConstants constants_of(const LoggedMotion& logged);

/// The constants as one line of text; empty if nothing was found.
std::string constants_words(const DriveConstants& constants);

}  // namespace host
