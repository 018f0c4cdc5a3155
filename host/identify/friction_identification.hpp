// The jogging procedure: friction at constant speeds, a curve through these points, and a model with this curve.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/identify/friction_fit.hpp"
#include "host/identify/friction_points.hpp"
#include "host/identify/tachometer.hpp"
#include "host/record/measurements.hpp"

namespace host {

enum class FrictionMethod {
  joint,  ///< one fit to the mean control signal, which does not depend on tachometer errors; steady points
          ///< only
  paper,  ///< section 3.2 as printed, from the Kalman disturbance
};

std::string_view method_name(FrictionMethod method);  ///< "joint", "paper"

/// Finds a method by its name. Throws Failure(usage) with the known names.
FrictionMethod friction_method_named(std::string_view name);

struct FrictionIdentification {
  FrictionMethod method{};
  sim::DriveDescription model;  ///< the given model with viscous, coulomb and stribeck from the fit
  FrictionFit fit;
  std::vector<FrictionPoint> points;
  double observer_viscous = 0.0;                    ///< B in the design of the observer
  std::optional<Estimate> viscous_by_disturbance;   ///< the same from the Kalman disturbance instead of the command
  std::optional<TachometerCalibration> tachometer;  ///< calibration by the encoder
  std::vector<std::string> warnings;
};

/// Identifies the friction curve from jogs at constant speeds in one or several records; the jogs are found
/// automatically. `model` gives inertia and viscous friction for the observer, which is designed with the default
/// options. A model with one Coulomb level for both directions keeps that form. Records need a position for the Kalman
/// disturbance. Throws Failure(refused) if there are too few constant speeds, Failure(bad_input) for an unusable model.
FrictionIdentification identify_friction(const Measurements& measured, const sim::DriveDescription& model,
                                         FrictionMethod method, const ConstantSpeedOptions& options = {});

}  // namespace host
