// Description of a drive: data-sheet values and a list of physical effects.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

enum class DriveKind { rotary, linear };

/// Data-sheet values of a drive. One set of equations serves both kinds:
/// speed w is rad/s (rotary) or m/s (linear), effort T is Nm or N, travel x is mm or m, and dx/dt = lead * w.
struct DataSheet {
  DriveKind kind = DriveKind::rotary;
  double amplifier_gain_A_per_V = 0.0;      ///< Ka, rotary only, > 0
  double torque_constant_Nm_per_A = 0.0;    ///< Kt, rotary only, > 0
  double force_constant_N_per_V = 0.0;      ///< linear only, > 0
  double lead = 1.0;                        ///< rg: mm/rad (rotary), 1 (linear: m per m)
  double sample_period_s = 0.001;           ///< Ts, > 0
  double dac_resolution_V = 0.0;            ///< du; 0 means ideal
  double dac_limit_V = 10.0;                ///< output range is -limit..+limit
  double encoder_resolution = 0.0;          ///< dx: mm (rotary) or m (linear); 0 means ideal
  double load_encoder_resolution = 0.0;     ///< of a scale on the table: mm or m; 0: there is none
  double load_encoder_cyclic_error = 0.0;   ///< amplitude of its error within its period, mm or m
  double load_encoder_cyclic_period = 0.0;  ///< mm or m
  double load_encoder_cyclic_phase_rad = 0.0;
  double load_encoder_offset_per_K = 0.0;     ///< drift of its zero as the machine warms, mm or m per kelvin
  std::optional<double> tach_noise_variance;  ///< (rad/s)^2 or (m/s)^2; empty: the drive has no tachometer

  /// Travel of a turn of the motor, mm; 0 for a linear drive.
  double turn() const { return kind == DriveKind::rotary ? 2.0 * std::numbers::pi * lead : 0.0; }

  bool has_load_encoder() const { return load_encoder_resolution > 0.0; }
  /// Error of the scale's reading, mm or m, at this many kelvin above the temperature at which its zero was taken.
  double load_encoder_error(double travel, double warmer_K = 0.0) const {
    const double offset = load_encoder_offset_per_K * warmer_K;
    if (!(load_encoder_cyclic_period > 0.0)) return offset;
    const double turns = travel / load_encoder_cyclic_period;
    return offset +
           load_encoder_cyclic_error * std::cos(2.0 * std::numbers::pi * turns - load_encoder_cyclic_phase_rad);
  }

  /// Effort at the shaft for one volt at the D/A converter: Ka*Kt in Nm/V, or N/V.
  double effort_per_volt() const {
    return kind == DriveKind::rotary ? amplifier_gain_A_per_V * torque_constant_Nm_per_A : force_constant_N_per_V;
  }
};

/// The id without its number. Parameters that an effect may have several times carry a number: "cosine_72", the cosine
/// of order 72, is of the family "cosine". An id without a number is its own family.
std::string_view family_of(std::string_view id);
std::string numbered_id(std::string_view family, double number);
/// The number in an id; empty if there is none.
std::optional<double> number_of(std::string_view id);

/// Prior knowledge of a parameter from a data sheet or a drawing.
struct Belief {
  double value = 0.0;
  double deviation = 0.0;  ///< standard deviation, > 0

  bool operator==(const Belief&) const = default;
};

/// One effect of a drive: its kind in the catalogue and the values of its parameters, by parameter id (no unit suffix).
struct EffectEntry {
  std::string kind;
  std::map<std::string, double> parameters;
  std::map<std::string, std::array<double, 2>> ci95;  ///< 95 % intervals of the fitted parameters
  std::string from;                                   ///< the record that the values came from; may be empty
  std::string over{};                                 ///< the coordinate of a free curve; otherwise empty
  std::set<std::string> held{};                       ///< parameters that a fit does not change
  std::map<std::string, Belief> believed{};           ///< priors; a fit changes only the value

  bool has(const std::string& id) const { return parameters.contains(id); }
  /// Whether it has a parameter of that family, with any number.
  bool has_any(std::string_view family) const;
  double at(const std::string& id) const { return parameters.at(id); }
  /// The magnitude for one direction: its own value, or the one for both directions.
  double either(const std::string& id, const std::string& both) const {
    const auto own = parameters.find(id);
    return std::abs(own != parameters.end() ? own->second : parameters.at(both));
  }
};

struct DriveDescription {
  std::string name;
  DataSheet data;
  std::vector<EffectEntry> effects;

  const EffectEntry* find(std::string_view kind) const;
  EffectEntry* find(std::string_view kind);
};

}  // namespace sim
