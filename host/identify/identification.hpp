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
  simple_ls,    ///< eqs. (20)-(25): friction left out
  unbiased_ls,  ///< eqs. (28)-(40): Coulomb friction estimated too. Encoder-only drives: all samples of the inverse
                ///< model
  sliding_ls,   ///< inverse model on the samples that slide for sure: free of the bias from tachometer noise
};

std::string_view method_name(IdentificationMethod method);  ///< "ls", "unbiased-ls", "sliding-ls"

/// Default method: sliding_ls with a tachometer, unbiased_ls with an encoder only.
IdentificationMethod default_method(const std::vector<Record>& records);

/// Finds a method by its name; an empty name gives the default. Throws Failure(usage) with the known names.
IdentificationMethod method_named(std::string_view name, const std::vector<Record>& records);

struct Identification {
  IdentificationMethod method{};
  sim::DriveDescription model;  ///< data sheet plus inertia, viscous, coulomb with intervals and origin
  RigidEstimate estimate;
  double relative_error = 0.0;  ///< of the inverse model on the same records
  bool by_speed = false;        ///< the motion was taken from the speed channel
  bool beside_travel = false;   ///< a curve along the travel absorbed effects that depend on position
  double cutoff_Hz = 0.0;       ///< of the zero-phase filter
  std::size_t decimation = 1;
  ExcitationSummary excitation;
  std::optional<TachometerCalibration> tachometer;
  std::optional<double> tach_noise_variance;  ///< measured at standstill (46)
  std::optional<AmplifierGain> amplifier;     ///< where all records have command and current
  std::optional<GainCheck> gain_check;        ///< by identify_with_gain()
  std::vector<std::string> warnings;
};

/// Identifies from one or several (training) records of the same drive and sampling period. `drive` gives the data
/// sheet; a base effect that it has in the one-level form keeps that form, other effects are not taken over (a warning
/// says so). sliding_ls corrects the tachometer by the encoder first, and takes the motion from it where the position
/// differentiates clearly worse; the paper's methods take the records as they are. If a curve over the travel explains
/// most of the residual of inertia and friction (gravity on an arm, a spring), the filtered methods estimate together
/// with it. The model can always be read again: an impossible friction value is set to its bound, and two levels of
/// which one would drive the axis are replaced by one level for both directions. Warnings say so; the estimate is not
/// changed. Throws Failure(refused) for insufficient excitation, Failure(bad_input) for records that do not fit the
/// drive.
Identification identify_drive(const Measurements& measured, const sim::DriveDescription& drive,
                              IdentificationMethod method, const MotionOptions& options = {});

/// Where a drive's torque per command comes from.
enum class GainSource {
  sheet,
  current,  ///< Ka from command and current of the records
  inertia,  ///< Kt*Ka from the added inertia
};
/// "sheet", "current", "inertia"; throws Failure(usage) for another name.
GainSource gain_source_named(std::string_view name);

struct AddedInertia {
  const Measurements& loaded;  ///< the same drive with it
  double value = 0.0;          ///< at the motor, kg m^2; of a linear drive kg; > 0
};

/// Inertia at the motor of a mass on the table (kg): m (lead / 1000)^2, or m of a linear drive.
double inertia_of_mass(double mass_kg, const sim::DataSheet& data);

/// The same with the gain checked or replaced, in the model too. A current's gain changes Ka (of a linear drive N/V);
/// that of an added inertia Ka too or, where the current gives Ka, Kt. Throws Failure(usage) if the source has no data,
/// and what check_gain() throws.
Identification identify_with_gain(const Measurements& measured, const sim::DriveDescription& drive,
                                  IdentificationMethod method, const MotionOptions& options, GainSource source,
                                  const std::optional<AddedInertia>& added);

}  // namespace host
