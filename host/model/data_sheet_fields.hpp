// The fields of `[drive]`: position in the file, target, and permitted values.
#pragma once

#include <optional>
#include <string_view>

#include "sim/drive_description.hpp"

namespace host {

enum class Presence {
  required,
  optional,
  of_volts,  ///< absent if torque or force is given only for the current
  alternative_unit,
};

struct DataSheetField {
  std::string_view table;  ///< "" for [drive], else the name of its sub-table
  std::string_view key;
  std::optional<sim::DriveKind> only;  ///< the only kind of drive that has it; empty for both
  double sim::DataSheet::*value;
  bool zero_allowed;  ///< no field may be negative
  Presence presence;
  std::string_view meaning;  ///< says where to find the value in a manufacturer's data sheet
  double divisor = 1.0;      ///< from the unit of the key to that of sim::DataSheet

  bool belongs_to(sim::DriveKind kind) const { return !only || *only == kind; }
};

/// The fields in the order in which they are written.
inline constexpr DataSheetField kDataSheetFields[] = {
    {"", "amplifier_gain_A_per_V", sim::DriveKind::rotary, &sim::DataSheet::amplifier_gain_A_per_V, false,
     Presence::of_volts, "Ka, A/V: the amplifier's current limit over its command range"},
    {"", "torque_constant_Nm_per_A", sim::DriveKind::rotary, &sim::DataSheet::torque_constant_Nm_per_A, false,
     Presence::required, "Kt, Nm/A: the motor's data sheet; per A rms if the log is in A rms"},
    {"", "lead_mm_per_rad", sim::DriveKind::rotary, &sim::DataSheet::lead, false, Presence::required,
     "mm/rad: travel per motor turn over 2 pi (10 mm per turn: 1.5915)"},
    {"", "force_constant_N_per_V", sim::DriveKind::linear, &sim::DataSheet::force_constant_N_per_V, false,
     Presence::of_volts, "N/V: N/A times the amplifier's A/V"},
    {"", "force_constant_N_per_A", sim::DriveKind::linear, &sim::DataSheet::torque_constant_Nm_per_A, false,
     Presence::optional, "N/A: the motor's data sheet"},
    {"",
     "sample_period_s",
     {},
     &sim::DataSheet::sample_period_s,
     false,
     Presence::required,
     "s: the controller's period, equal to that of the log"},
    {"dac",
     "resolution_V",
     {},
     &sim::DataSheet::dac_resolution_V,
     true,
     Presence::of_volts,
     "V: resolution of the command's converter (20 V, 16 bit: 3.05e-4)"},
    {"dac",
     "limit_V",
     {},
     &sim::DataSheet::dac_limit_V,
     false,
     Presence::of_volts,
     "V: the converter's range is -limit to +limit; default 10"},
    {"encoder", "resolution_mm", sim::DriveKind::rotary, &sim::DataSheet::encoder_resolution, true, Presence::optional,
     "mm: travel of one count (10 mm per turn, 65536 counts: 1.526e-4)"},
    {"encoder", "resolution_m", sim::DriveKind::linear, &sim::DataSheet::encoder_resolution, true, Presence::optional,
     "m: travel of one count"},
    {"encoder", "resolution_mm", sim::DriveKind::linear, &sim::DataSheet::encoder_resolution, true,
     Presence::alternative_unit, "mm: travel of one count, instead of resolution_m", 1000.0},
    {"load_encoder", "resolution_mm", sim::DriveKind::rotary, &sim::DataSheet::load_encoder_resolution, false,
     Presence::optional, "mm: one count of a scale on the table, if there is one (the record's x2_mm)"},
    {"load_encoder", "resolution_m", sim::DriveKind::linear, &sim::DataSheet::load_encoder_resolution, false,
     Presence::optional, "m: one count of a scale on the table, if there is one (the record's x2_m)"},
    {"load_encoder", "resolution_mm", sim::DriveKind::linear, &sim::DataSheet::load_encoder_resolution, false,
     Presence::alternative_unit, "mm: the same, instead of resolution_m", 1000.0},
    {"load_encoder", "cyclic_error_mm", sim::DriveKind::rotary, &sim::DataSheet::load_encoder_cyclic_error, true,
     Presence::optional, "mm: amplitude of the scale's cyclic error"},
    {"load_encoder", "cyclic_error_m", sim::DriveKind::linear, &sim::DataSheet::load_encoder_cyclic_error, true,
     Presence::optional, "m: amplitude of the scale's cyclic error"},
    {"load_encoder", "cyclic_period_mm", sim::DriveKind::rotary, &sim::DataSheet::load_encoder_cyclic_period, false,
     Presence::optional, "mm: period of this error, usually that of the scale's grating (0.02)"},
    {"load_encoder", "cyclic_period_m", sim::DriveKind::linear, &sim::DataSheet::load_encoder_cyclic_period, false,
     Presence::optional, "m: period of this error, usually that of the scale's grating (2e-5)"},
    {"load_encoder",
     "cyclic_phase_rad",
     {},
     &sim::DataSheet::load_encoder_cyclic_phase_rad,
     true,
     Presence::optional,
     "rad: phase of the period at which the error is largest; 0 by default"},
    {"load_encoder", "offset_mm_per_K", sim::DriveKind::rotary, &sim::DataSheet::load_encoder_offset_per_K, true,
     Presence::optional, "mm/K: shift of the scale's zero per kelvin of the record's temp_C"},
    {"load_encoder", "offset_m_per_K", sim::DriveKind::linear, &sim::DataSheet::load_encoder_offset_per_K, true,
     Presence::optional, "m/K: shift of the scale's zero per kelvin of the record's temp_C"},
};

/// Variance of the tachometer's noise: the only field that sim::DataSheet may lack.
constexpr std::string_view tach_noise_key(sim::DriveKind kind) {
  return kind == sim::DriveKind::rotary ? "noise_variance_rad2_s2" : "noise_variance_m2_s2";
}

}  // namespace host
