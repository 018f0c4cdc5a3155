// The catalogue's entry of one physical effect. It makes the effect available to plant, predictor, fit, model file,
// catalogue page, diagnosis and tests.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "sim/drive_description.hpp"

namespace sim {

class Drive;

/// The quantity in whose units `ParameterInfo::starts` are given, so that one list suits drives of any size.
enum class Scale {
  unity,               ///< no scaling
  coulomb,             ///< the drive's Coulomb level, Nm or N
  inertia,             ///< the drive's inertia, kg m^2 or kg
  viscous,             ///< the drive's viscous coefficient
  bristle_stiffness,   ///< the Coulomb level over 20 um of travel
  bristle_damping,     ///< critical damping of the inertia on bristles of that stiffness
  coulomb_per_travel,  ///< the Coulomb level over the travel of the records
  stall_effort,        ///< effort at the converter's limit, Nm or N
  stall_current,       ///< current at the converter's limit, A; a linear drive's force, N
  speed,               ///< 1.59 mm/s of travel, as shaft or table speed: 1 rad/s of a screw of 10 mm pitch
  converter_range,     ///< largest voltage of the D/A converter, V
  millimetre,          ///< 1 mm; 0.001 m for a linear drive
  top_speed,           ///< the highest speed of the records
  travel,              ///< the travel that the records cover
  position,            ///< the same, from the middle of that travel
  duration,            ///< the length of the longest record, s
  first_stamp,         ///< the earliest time stamp of the records, s; never fitted
};

struct ParameterInfo {
  std::string_view id;          ///< name without unit
  std::string_view rotary_key;  ///< key in the model file of a rotary drive, with its unit
  std::string_view linear_key;  ///< the same for a linear drive
  std::string_view doc;         ///< one line
  double lower;                 ///< physical bounds, in the unit of the key
  double upper;
  Scale scale = Scale::unity;
  std::vector<double> starts{};  ///< start values of a fit, in units of `scale`; several for several local minima
  bool optional = false;         ///< may be absent from a model file
  bool absent_at_lower = false;  ///< at the lower bound this part of the effect is absent: an undamped spring
  bool absent_at_upper = false;  ///< the same at the upper bound: a contact without a spring, a motor without friction
  std::string_view pair_of{};  ///< set for a parameter that gives both directions: replaces the pair positive/negative

  std::string_view key(DriveKind kind) const { return kind == DriveKind::rotary ? rotary_key : linear_key; }

  /// Whether a fitted value lies on a bound and is therefore not an estimate. A bound at which this part of the effect
  /// is absent is a valid value, and so is zero or a lower bound that stands for zero.
  bool is_stopped_at(double value) const {
    constexpr double kNear = 1e-3, kStandsForZero = 5e-4;  // of the bound; of the upper bound
    const auto lies_on = [&](double bound) {
      return std::abs(bound) > kStandsForZero * std::abs(upper) && std::isfinite(bound) &&
             std::abs(value - bound) <= kNear * std::abs(bound);
    };
    return (lies_on(lower) && !absent_at_lower) || (lies_on(upper) && !absent_at_upper);
  }
};

/// The place of an effect in the drive, which determines the searches that include it. Effects on the `table` are
/// visible only with a sensor on the table.
enum class Stage { command, motor, load, friction, mechanics, encoder, tachometer, table };

/// The figure that shows an effect at a glance.
enum class View {
  curve,   ///< the residual over one coordinate of EffectInfo::along, forward and backward apart
  starts,  ///< the torque or force of each start from rest, over the duration of the rest
  moment   ///< the residual of the predicted motion, sample by sample, where the effect shows most
};

struct EffectInfo {
  std::string_view kind;
  std::string_view title;
  std::string_view equation;
  Stage stage;
  bool base = false;  ///< inertia, viscous, coulomb: re-fitted first, never reported as found
  /// Has parameters `cosine`, `sine` and `period` over the travel, the first two once for every order: "cosine" is the
  /// first, "cosine_6" the sixth.
  bool periodic = false;
  /// A curve over a coordinate (EffectEntry::over): has parameters `knot` and `value`, each once for every knot,
  /// numbered from 0.
  bool curve = false;
  std::vector<ParameterInfo> parameters;
  std::string_view shows;  ///< how it shows in the residual
  /// Coordinates on which its residual depends, for a diagnosis without this effect: speed, position,
  /// travel_since_reversal, acceleration, current, rest, time, frequency.
  std::vector<std::string_view> along{};
  View view = View::curve;
  std::vector<std::string_view> confused_with;  ///< kinds with a similar residual
  std::string_view separate_by;                 ///< the experiment that tells them apart
  std::string_view origin;                      ///< its cause in a machine
  std::string_view remedy;                      ///< remedies for a mechanic or an electrician
  void (*install)(const EffectEntry& entry, const DataSheet& data, Drive& drive);

  /// The parameter of that id, with any number after it; or nullptr.
  const ParameterInfo* parameter(std::string_view id) const;
};

}  // namespace sim
