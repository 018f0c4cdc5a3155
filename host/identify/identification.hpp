// From records to a model: inertia, viscous and Coulomb friction of a drive, its tachometer and its noise.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/identify/drive_gains.hpp"
#include "host/identify/excitation_check.hpp"
#include "host/identify/tachometer.hpp"
#include "host/record/measurements.hpp"

namespace host {

enum class IdentificationMethod {
  simple_ls,    ///< eqs. (20)-(25), without Coulomb friction
  unbiased_ls,  ///< eqs. (28)-(40), with Coulomb friction. Drives with an encoder only: all samples of the inverse
                ///< model
  sliding_ls,   ///< inverse model on certainly sliding samples; not biased by tachometer noise
};

std::string_view method_name(IdentificationMethod method);  ///< "ls", "unbiased-ls", "sliding-ls"

/// The default method: sliding_ls with a tachometer, unbiased_ls with an encoder only.
IdentificationMethod default_method(const std::vector<Record>& records);

/// Finds a method by its name; an empty name gives the default. Throws Failure(usage) with the known names.
IdentificationMethod method_named(std::string_view name, const std::vector<Record>& records);

struct Identification {
  IdentificationMethod method{};
  sim::DriveDescription model;  ///< data sheet plus inertia, viscous, coulomb with intervals and origin
  RigidEstimate estimate;
  double relative_error = 0.0;  ///< relative error of the inverse model on the same records
  bool by_speed = false;        ///< the motion comes from the speed channel
  bool beside_travel = false;   ///< a curve along the travel absorbed effects that depend on position
  double cutoff_Hz = 0.0;       ///< cut-off of the zero-phase filter
  std::size_t decimation = 1;
  ExcitationSummary excitation;
  std::optional<TachometerCalibration> tachometer;
  std::optional<double> tach_noise_variance;  ///< tachometer noise measured at standstill (46)
  std::optional<AmplifierGain> amplifier;     ///< if all records have command and current
  std::optional<GainCheck> gain_check;        ///< set by identify_with_gain()
  std::vector<std::string> warnings;
};

/// Identifies from one or several training records of the same drive and sampling period. `drive` gives the data sheet.
/// A base effect that it has in the one-level form keeps that form; other effects are left out, with a warning.
/// sliding_ls first corrects the tachometer by the encoder, and takes the motion from the tachometer if the
/// differentiated position is clearly worse; the paper's methods use the records as they are. If a curve over the
/// travel explains most of the residual of inertia and friction (gravity on an arm, a spring), the filtered methods
/// include it in the estimate. The model can always be read again: an impossible friction value is set to its bound,
/// and two levels of which one would drive the axis are replaced by one level for both directions. Warnings say so; the
/// estimate does not change. Throws Failure(refused) for insufficient excitation, Failure(bad_input) for records that
/// do not fit the drive.
Identification identify_drive(const Measurements& measured, const sim::DriveDescription& drive,
                              IdentificationMethod method, const MotionOptions& options = {});

/// Source of a drive's torque per command.
enum class GainSource {
  sheet,
  current,  ///< Ka from command and current of the records
  inertia,  ///< Kt*Ka from the added inertia
};
/// "sheet", "current", "inertia"; throws Failure(usage) for another name.
GainSource gain_source_named(std::string_view name);

struct AddedInertia {
  const Measurements& loaded;  ///< records of the same drive with the added inertia
  double value = 0.0;          ///< added inertia at the motor, kg m^2; kg for a linear drive; > 0
};

/// Inertia at the motor of a mass on the table (kg): m (lead / 1000)^2, or m for a linear drive.
double inertia_of_mass(double mass_kg, const sim::DataSheet& data);

/// As identify_drive(), with the gain checked or replaced, also in the model. The gain from the current replaces Ka
/// (N/V for a linear drive). The gain from an added inertia replaces Ka too, or Kt if the current gives Ka. Throws
/// Failure(usage) if the records or options for the source are missing, and what check_gain() throws.
Identification identify_with_gain(const Measurements& measured, const sim::DriveDescription& drive,
                                  IdentificationMethod method, const MotionOptions& options, GainSource source,
                                  const std::optional<AddedInertia>& added);

}  // namespace host
