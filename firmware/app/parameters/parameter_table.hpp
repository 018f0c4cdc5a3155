// The table of all parameters. Storage, checks, ids of store and protocol, help, documentation and the schema hash are
// derived from it: a new parameter is a new row here and its use by name, values.get<"group.name">(). The thresholds of
// monitors have a table of their own, firmware/core/supervision/monitor_limits.hpp (ids 144 to 159 and 251).
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "firmware/core/supervision/monitor_limits.hpp"

namespace firmware {

namespace parameter_rows {

using enum ParameterScope;
using enum ParameterType;
using enum ParameterChange;

// Ranges exclude gross errors (a sign, a factor of a thousand); consistency of the values is checked when a whole set
// is taken over. If the units of rotary and linear drives differ, the range covers both.
inline constexpr std::array kOwnRows = std::to_array<ParameterInfo>({
    // id scope  name                        type    unit            linear     minimum maximum initial  change
    {1, board, "control.rate", whole, "Hz", "Hz", 250, 20000, 1000, while_disabled,
     "control periods per second; equals 1 / drive.sample_period of every fitted axis"},
    {2, board, "host.timeout", real, "s", "s", 0.02F, 10, 0.2F, while_disabled,
     "silence of the commanding client after which the axes slow down and stop"},
    {3, board, "host.standing_timeout", real, "s", "s", 0.1F, 3600, 60, any_time,
     "the same for axes at rest: after it they are disabled"},
    {4, board, "emergency_stop.delay", real, "s", "s", 0, 5, 0, while_disabled,
     "for which axes may slow down along their ramps after the stop circuit has opened (stop category 1)"},
    {5, board, "probe.input", whole, "", "", 0, 2, 0, while_disabled,
     "touch probe: 0 none is wired; 1 its input closes on contact; 2 it opens on contact"},

    {16, axis, "drive.fitted", toggle, "", "", 0, 1, 0, while_disabled, "the axis exists: it can be enabled"},
    {17, axis, "drive.sample_period", real, "s", "s", 5e-5F, 4e-3F, 1e-3F, while_disabled,
     "control period for which model and gains are designed"},
    {18, axis, "drive.lead", real, "mm/rad", "1", 1e-6F, 1e4F, 1, while_disabled,
     "travel per shaft angle, rg; 1 for a linear drive"},
    {19, axis, "drive.encoder_resolution", real, "mm", "m", 1e-9F, 10, 1e-3F, while_disabled, "travel per count"},
    {20, axis, "drive.dac_resolution", real, "V", "V", 1e-6F, 0.1F, 20.0F / 65536, while_disabled,
     "command per step of the D/A converter"},
    {21, axis, "drive.dac_limit", real, "V", "V", 1e-3F, 20, 10, while_disabled, "largest command, both signs"},
    {22, axis, "drive.effort_per_volt", real, "Nm/V", "N/V", 1e-6F, 1e6F, 1, while_disabled,
     "Ka Kt; converts friction to volts"},

    {32, axis, "tachometer.fitted", toggle, "", "", 0, 1, 1, while_disabled, "off: the estimate uses only the encoder"},
    {33, axis, "tachometer.gain", real, "rad/s", "m/s", -1e3F, 1e3F, 1.0F / 64, while_disabled,
     "speed per code of its A/D converter"},
    {34, axis, "tachometer.offset", real, "rad/s", "m/s", -1e4F, 1e4F, 0, while_disabled,
     "reading at standstill; subtracted"},
    // 40 to 43 are reserved for a second encoder on the table: scale.fitted, .resolution, .reversed, .disagreement.

    {48, axis, "model.a12", real, "mm/(rad/s)", "m/(m/s)", 0, 100, 0, while_disabled,
     "travel in a period per speed, eq. (7)"},
    {49, axis, "model.a22", real, "1", "1", 0, 1, 0, while_disabled, "pole of the drive, eq. (6)"},
    {50, axis, "model.b1", real, "mm/V", "m/V", 0, 1e3F, 0, while_disabled, "travel in a period per command"},
    {51, axis, "model.b2", real, "rad/s/V", "m/s/V", 0, 1e5F, 0, while_disabled,
     "speed gained in a period per command"},

    {64, axis, "kalman.k11", real, "1", "1", -2, 2, 0, while_disabled,
     "correction of the position by the encoder, eq. (43)"},
    {65, axis, "kalman.k12", real, "mm/(rad/s)", "m/(m/s)", -100, 100, 0, while_disabled,
     "correction of the position by the tachometer, eq. (43)"},
    {66, axis, "kalman.k21", real, "(rad/s)/mm", "(m/s)/m", -1e6F, 1e6F, 0, while_disabled,
     "correction of the speed by the encoder, eq. (43)"},
    {67, axis, "kalman.k22", real, "1", "1", -2, 2, 0, while_disabled,
     "correction of the speed by the tachometer, eq. (43)"},
    {68, axis, "kalman.k31", real, "V/mm", "V/m", -1e7F, 1e7F, 0, while_disabled,
     "correction of the disturbance by the encoder, eq. (43)"},
    {69, axis, "kalman.k32", real, "V/(rad/s)", "V/(m/s)", -1e5F, 1e5F, 0, while_disabled,
     "correction of the disturbance by the tachometer, eq. (43)"},

    {80, axis, "feedback.k1", real, "V/mm", "V/m", 0, 1e7F, 0, while_disabled, "on the position error, eq. (50)"},
    {81, axis, "feedback.k2", real, "V/(rad/s)", "V/(m/s)", -1e5F, 1e5F, 0, while_disabled,
     "on the speed error, eq. (50)"},
    {82, axis, "feedback.cancel_disturbance", toggle, "", "", 0, 1, 0, while_disabled,
     "add the estimated disturbance to the command"},
    {83, axis, "feedback.hold_effort", real, "Nm", "N", 0, 1e6F, 0, while_disabled,
     "estimated disturbance above which the feed of a path is held until it is released; with feedforward.friction it "
     "is the process force; 0: no limit"},

    {96, axis, "feedforward.zero_phase", toggle, "", "", 0, 1, 0, while_disabled,
     "zero phase error tracking; off: the reference speed alone, eqs. (50) and (52)"},
    {97, axis, "feedforward.friction", toggle, "", "", 0, 1, 0, while_disabled,
     "add the friction of the reference speed to the command, eq. (19)"},
    {98, axis, "feedforward.friction_watch", toggle, "", "", 0, 1, 0, while_disabled,
     "take friction feed-forward back while the axis has followed worse with it over its last strokes"},

    {112, axis, "friction.static_positive", real, "Nm", "N", 0, 1e6F, 0, while_disabled,
     "magnitude at standstill, eq. (19)"},
    {113, axis, "friction.coulomb_positive", real, "Nm", "N", 0, 1e6F, 0, while_disabled,
     "magnitude at speed, eq. (19)"},
    {114, axis, "friction.viscous_positive", real, "Nm/(rad/s)", "N/(m/s)", -1e6F, 1e6F, 0, while_disabled,
     "in addition to the part in model.a22"},
    {115, axis, "friction.omega1_positive", real, "rad/s", "m/s", 0, 1e4F, 0, while_disabled,
     "fading of the static part, eq. (19)"},
    {116, axis, "friction.omega2_positive", real, "rad/s", "m/s", 0, 1e4F, 0, while_disabled,
     "rise of the Coulomb part, eq. (19)"},
    {117, axis, "friction.static_negative", real, "Nm", "N", 0, 1e6F, 0, while_disabled,
     "magnitude at standstill, eq. (19)"},
    {118, axis, "friction.coulomb_negative", real, "Nm", "N", 0, 1e6F, 0, while_disabled,
     "magnitude at speed, eq. (19)"},
    {119, axis, "friction.viscous_negative", real, "Nm/(rad/s)", "N/(m/s)", -1e6F, 1e6F, 0, while_disabled,
     "in addition to the part in model.a22"},
    {120, axis, "friction.omega1_negative", real, "rad/s", "m/s", 0, 1e4F, 0, while_disabled,
     "fading of the static part, eq. (19)"},
    {121, axis, "friction.omega2_negative", real, "rad/s", "m/s", 0, 1e4F, 0, while_disabled,
     "rise of the Coulomb part, eq. (19)"},
    {122, axis, "friction.blend", real, "rad/s", "m/s", 1e-6F, 1e3F, 0.06F, while_disabled,
     "speed below which the compensation decreases linearly to 0"},

    {128, axis, "limits.velocity", real, "mm/s", "m/s", 1e-6F, 1e6F, 250, while_disabled, "of references"},
    {129, axis, "limits.acceleration", real, "mm/s^2", "m/s^2", 1e-6F, 1e8F, 2000, while_disabled, "of references"},
    {130, axis, "limits.jerk", real, "mm/s^3", "m/s^3", 1e-6F, 1e10F, 50000, while_disabled, "of references"},
    {131, axis, "limits.fault_deceleration", real, "mm/s^2", "m/s^2", 0, 1e8F, 0, while_disabled,
     "of the ramp after a fault; from 0 to limits.acceleration: limits.acceleration is used"},
    {132, axis, "limits.unhomed_velocity", real, "mm/s", "m/s", 0, 1e6F, 0, while_disabled,
     "of jogs and moves before homing; 0: limits.velocity"},

    // Further effects of a drive that identification finds: firmware/core/compensation.
    {160, axis, "calibration.tachometer_gain", real, "1", "1", 0.5F, 2, 1, while_disabled,
     "reading over true speed; 1: correct"},
    {161, axis, "calibration.tachometer_offset", real, "rad/s", "m/s", -1e3F, 1e3F, 0, while_disabled,
     "remaining offset; subtracted in addition to tachometer.offset"},

    {176, axis, "cogging.on", toggle, "", "", 0, 1, 0, while_disabled,
     "subtract the cogging at the reference position from the command"},
    {177, axis, "cogging.cosine_1", real, "Nm", "N", -1e5F, 1e5F, 0, while_disabled,
     "cogging torque or force over the travel from home; acts once homed"},
    {178, axis, "cogging.sine_1", real, "Nm", "N", -1e5F, 1e5F, 0, while_disabled, "likewise"},
    {179, axis, "cogging.period_1", real, "mm", "m", 1e-6F, 1e6F, 10, while_disabled, "travel of one period"},
    {180, axis, "cogging.cosine_2", real, "Nm", "N", -1e5F, 1e5F, 0, while_disabled, "second harmonic"},
    {181, axis, "cogging.sine_2", real, "Nm", "N", -1e5F, 1e5F, 0, while_disabled, "second harmonic"},
    {182, axis, "cogging.period_2", real, "mm", "m", 1e-6F, 1e6F, 10, while_disabled, "second harmonic"},
    {183, axis, "cogging.cosine_3", real, "Nm", "N", -1e5F, 1e5F, 0, while_disabled, "third harmonic"},
    {184, axis, "cogging.sine_3", real, "Nm", "N", -1e5F, 1e5F, 0, while_disabled, "third harmonic"},
    {185, axis, "cogging.period_3", real, "mm", "m", 1e-6F, 1e6F, 10, while_disabled, "third harmonic"},

    {192, axis, "presliding.on", toggle, "", "", 0, 1, 0, while_disabled,
     "let friction feed-forward build up over the travel after a reversal"},
    {193, axis, "presliding.stiffness", real, "Nm/rad", "N/m", 0, 1e9F, 0, while_disabled,
     "of the contact before slip, sigma0"},
    {194, axis, "presliding.damping", real, "Nm/(rad/s)", "N/(m/s)", 0, 1e6F, 0, while_disabled, "likewise, sigma1"},

    {208, axis, "position_friction.on", toggle, "", "", 0, 1, 0, while_disabled,
     "let friction feed-forward follow the travel"},
    {209, axis, "position_friction.cosine", real, "1", "1", -0.95F, 0.95F, 0, while_disabled,
     "relative increase of friction over the travel from home; acts once homed"},
    {210, axis, "position_friction.sine", real, "1", "1", -0.95F, 0.95F, 0, while_disabled, "likewise"},
    {211, axis, "position_friction.period", real, "mm", "m", 1e-6F, 1e6F, 100, while_disabled, "travel of one period"},

    {224, axis, "backlash.on", toggle, "", "", 0, 1, 0, while_disabled,
     "shift the reference by half the gap plus the wind-up, in the direction of motion"},
    {225, axis, "backlash.gap", real, "mm", "m", 0, 10, 0, while_disabled, "free travel of the table"},
    {226, axis, "backlash.crossing_time", real, "s", "s", 1e-3F, 0.2F, 0.01F, while_disabled,
     "time for crossing the gap"},
    {227, axis, "backlash.wind_up", real, "mm", "m", 0, 10, 0, while_disabled,
     "twist behind the gap under friction; friction reaches the motor as the twist builds up"},

    {240, axis, "homing.mode", whole, "", "", 0, 3, 0, while_disabled,
     "how to home: 0 by the operator; 1 by the switch; 2 by the index; 3 by the switch, then the index"},
    {241, axis, "homing.velocity", real, "mm/s", "m/s", -1e6F, 1e6F, 10, while_disabled,
     "of the search; its sign is the direction to the switch"},
    {242, axis, "homing.creep_velocity", real, "mm/s", "m/s", 1e-6F, 1e6F, 1, while_disabled,
     "for finding the switch's edge and the index"},
    {243, axis, "homing.travel", real, "mm", "m", 1e-6F, 1e6F, 1000, while_disabled, "longest travel of each search"},
    {244, axis, "homing.index_travel", real, "mm", "m", 1e-6F, 1e6F, 10, while_disabled,
     "travel within which an index pulse must come: slightly more than a turn"},
    {245, axis, "homing.position", real, "mm", "m", -1e6F, 1e6F, 0, while_disabled, "of home"},

    {246, axis, "amplifier.ready_input", toggle, "", "", 0, 1, 0, while_disabled,
     "the amplifier's ready contact is wired: the loop closes when the amplifier reports ready, and opens when it no "
     "longer does"},
    {247, axis, "amplifier.ready_time", real, "s", "s", 0, 10, 0, while_disabled,
     "from the enable until the amplifier drives; with the ready input the time-out for this"},

    {248, axis, "brake.fitted", toggle, "", "", 0, 1, 0, while_disabled,
     "released once the loop is closed, applied before it opens"},
    {249, axis, "brake.release_time", real, "s", "s", 0, 5, 0.1F, while_disabled,
     "until a released brake is open: no motion before"},
    {250, axis, "brake.apply_time", real, "s", "s", 0, 5, 0.1F, while_disabled,
     "until an applied brake holds: the enable stays on until then"},

    {252, axis, "encoder.fault_input", toggle, "", "", 0, 1, 0, while_disabled,
     "the fault output of the encoder's line receivers is wired: a broken wire stops the axis"},

    // For an excitation in open loop: app/limit_reply.hpp.
    {256, axis, "unfitted.volts", real, "V", "V", 0, 20, 6, while_disabled,
     "largest command of an experiment while the axis is not fitted"},
    {257, axis, "unfitted.time", real, "s", "s", 0, 3600, 120, while_disabled, "longest experiment, likewise"},
    {258, axis, "unfitted.counts", whole, "", "", 1, 268435456, 1000000, while_disabled,
     "farthest travel of an experiment in each direction, counts, while the axis is not fitted"},

    // Filters after the feedback: firmware/core/control/control_filter.hpp.
    {272, axis, "notch.on", toggle, "", "", 0, 1, 0, while_disabled, "remove a resonance's frequency from the command"},
    {273, axis, "notch.frequency", real, "Hz", "Hz", 1, 1e4F, 100, while_disabled, "below 0.45 of the control rate"},
    {274, axis, "notch.damping", real, "1", "1", 0.01F, 2, 0.5F, while_disabled, "half its width over its frequency"},
    {275, axis, "notch.depth", real, "1", "1", 0, 1, 0.1F, while_disabled, "gain at its frequency"},
    {276, axis, "low_pass.on", toggle, "", "", 0, 1, 0, while_disabled, "low-pass of the command"},
    {277, axis, "low_pass.frequency", real, "Hz", "Hz", 1, 1e4F, 300, while_disabled,
     "of its two poles; below 0.45 of the control rate"},
    {278, axis, "low_pass.damping", real, "1", "1", 0.1F, 2, 0.7F, while_disabled, "of its two poles"},

    // The table itself is stored beside the parameters: firmware/core/compensation/pitch_table.hpp.
    {288, axis, "pitch.on", toggle, "", "", 0, 1, 0, while_disabled,
     "subtract the screw's error from the reference, by the axis's table (axistool pitch); acts once homed"},
    {289, axis, "pitch.crossing_time", real, "s", "s", 1e-3F, 0.2F, 0.05F, while_disabled,
     "time for crossing at a reversal"},
});

using Rows = std::array<ParameterInfo, kOwnRows.size() + kThresholdRows.size()>;

/// All rows, including the monitors' thresholds, in the order of the ids.
constexpr Rows with_thresholds() {
  Rows rows{};
  std::size_t place = 0;
  for (const ParameterInfo& row : kOwnRows) rows[place++] = row;
  for (const ThresholdRow& row : kThresholdRows) rows[place++] = row.parameter();
  std::ranges::sort(rows, {}, &ParameterInfo::id);
  return rows;
}

inline constexpr Rows kRows = with_thresholds();

}  // namespace parameter_rows

inline constexpr const auto& kParameters = parameter_rows::kRows;

namespace parameter_rows {

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    const ParameterInfo& row = kRows[i];
    if (row.id == 0 || row.id > 0xFFF || (i > 0 && row.id <= kRows[i - 1].id)) return false;
    if (i > 0 && kRows[i - 1].scope == axis && row.scope == board) return false;
    const ParameterRule rule{row.id, row.type, row.change, row.minimum, row.maximum, row.initial};
    if (check_value(rule, row.initial) != ValueRefusal::none || !(row.minimum < row.maximum)) return false;
    for (std::size_t other = 0; other < i; ++other)
      if (kRows[other].name == row.name) return false;
  }
  return true;
}
static_assert(is_in_order(), "ids rise, the board's rows come first, names are unique, initial values are admissible");

constexpr std::uint32_t hash_bytes(std::uint32_t hash, std::string_view text) {
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
  return (hash ^ 0xFF) * 16777619u;  // ends the text: "ab" "c" differs from "a" "bc"
}

constexpr std::uint32_t hash_word(std::uint32_t hash, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ ((word >> shift) & 0xFF)) * 16777619u;
  return hash;
}

/// FNV-1a (Fowler, Noll, Vo) over everything but the lines of documentation.
constexpr std::uint32_t schema_hash(std::span<const ParameterInfo> rows) {
  std::uint32_t hash = 2166136261u;
  for (const ParameterInfo& row : rows) {
    hash = hash_word(hash, row.id);
    hash = hash_bytes(hash_bytes(hash_bytes(hash, row.name), row.unit), row.linear_unit);
    hash = hash_word(hash, static_cast<std::uint32_t>(row.scope) | static_cast<std::uint32_t>(row.type) << 8 |
                               static_cast<std::uint32_t>(row.change) << 16);
    for (const float value : {row.minimum, row.maximum, row.initial})
      hash = hash_word(hash, std::bit_cast<std::uint32_t>(value));
  }
  return hash;
}

}  // namespace parameter_rows

/// Equal hashes mean equal tables: names, ids, units, types, ranges and initial values.
inline constexpr std::uint32_t kSchemaHash = parameter_rows::schema_hash(kParameters);

}  // namespace firmware
