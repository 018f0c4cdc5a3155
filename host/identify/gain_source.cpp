// Identification with a gain from the records instead of that of the data sheet.
#include <fmt/format.h>

#include <cmath>

#include "host/exit_codes.hpp"
#include "host/identify/identification.hpp"

namespace host {

namespace {

/// Torque per volt, or per ampere of records without a command.
double assumed_gain(const Measurements& measured, const sim::DataSheet& data) {
  return measured.training().front().u_V.empty() ? data.torque_constant_Nm_per_A : data.effort_per_volt();
}

sim::DriveDescription with_amplifier(sim::DriveDescription drive, const std::optional<AmplifierGain>& amplifier) {
  if (!amplifier)
    throw Failure(
        ExitCode::usage,
        "--gain current: the records need u_V and i_A, of a current amplifier: the current follows the command");
  sim::DataSheet& data = drive.data;
  if (data.kind == sim::DriveKind::rotary) {
    data.amplifier_gain_A_per_V = amplifier->gain.value;
    return drive;
  }
  if (!(data.torque_constant_Nm_per_A > 0.0))
    throw Failure(ExitCode::usage, "--gain current: a linear drive needs force_constant_N_per_A in [drive] for it");
  data.force_constant_N_per_V = data.torque_constant_Nm_per_A * amplifier->gain.value;
  return drive;
}

sim::DriveDescription with_factor(sim::DriveDescription drive, const Identification& found, bool has_volts) {
  const double factor = found.gain_check->factor.value;
  sim::DataSheet& data = drive.data;
  if (!has_volts) {
    data.torque_constant_Nm_per_A *= factor;
  } else if (data.kind == sim::DriveKind::linear) {
    data.force_constant_N_per_V *= factor;
  } else if (found.amplifier) {
    data.torque_constant_Nm_per_A *= factor * data.amplifier_gain_A_per_V / found.amplifier->gain.value;
    data.amplifier_gain_A_per_V = found.amplifier->gain.value;
  } else {
    data.amplifier_gain_A_per_V *= factor;
  }
  return drive;
}

}  // namespace

GainSource gain_source_named(std::string_view name) {
  using enum GainSource;
  if (name == "sheet") return sheet;
  if (name == "current") return current;
  if (name == "inertia") return inertia;
  throw Failure(ExitCode::usage, fmt::format("--gain: {} not in {{sheet,current,inertia}}", name));
}

double inertia_of_mass(double mass_kg, const sim::DataSheet& data) {
  return data.kind == sim::DriveKind::linear ? mass_kg : mass_kg * std::pow(data.lead / 1000.0, 2);
}

Identification identify_with_gain(const Measurements& measured, const sim::DriveDescription& drive,
                                  IdentificationMethod method, const MotionOptions& options, GainSource source,
                                  const std::optional<AddedInertia>& added) {
  Identification found = identify_drive(measured, drive, method, options);
  if (added) {
    const Identification loaded = identify_drive(added->loaded, drive, method, options);
    found.gain_check =
        check_gain(found.estimate.inertia, loaded.estimate.inertia, added->value, assumed_gain(measured, drive.data));
    const Estimate& factor = found.gain_check->factor;
    if (source != GainSource::inertia && (factor.ci95[0] > 1.0 || factor.ci95[1] < 1.0))
      found.warnings.push_back(fmt::format(
          "the added inertia shows {:.4g} times the torque of the data sheet ({:.4g} to {:.4g}): inertia and "
          "friction are off by as much. --gain inertia takes the measured gain",
          factor.value, factor.ci95[0], factor.ci95[1]));
  }
  if (source == GainSource::sheet) return found;
  if (source == GainSource::inertia && !added)
    throw Failure(ExitCode::usage, "--gain inertia: give --loaded, and --added-mass or --added-inertia");
  const sim::DriveDescription measured_drive =
      source == GainSource::current ? with_amplifier(drive, found.amplifier)
                                    : with_factor(drive, found, !measured.training().front().u_V.empty());
  Identification again = identify_drive(measured, measured_drive, method, options);
  again.gain_check = found.gain_check;
  return again;
}

}  // namespace host
