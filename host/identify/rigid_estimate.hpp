// Inertia, viscous and Coulomb friction by least squares: the paper's discrete estimator and the filtered inverse
// model.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host/identify/least_squares.hpp"
#include "host/identify/motion.hpp"
#include "host/record/record.hpp"

namespace host {

/// A value with its 95 % interval.
struct Estimate {
  double value = 0.0;
  std::array<double, 2> ci95{};
  double half_width() const { return 0.5 * (ci95[1] - ci95[0]); }
};

struct RigidEstimate {
  Estimate inertia;                  ///< J, kg m^2 (kg)
  Estimate viscous;                  ///< B, Nm s/rad (N s/m)
  std::optional<Estimate> positive;  ///< Coulomb level forward, > 0, Nm (N); empty if friction was left out
  std::optional<Estimate> negative;  ///< Coulomb level backward, < 0
  double condition_number = 0.0;
  double relative_residual = 0.0;  ///< relative residual of the regressed quantity, 0 to 1
  std::size_t rows = 0;
};

/// Whether Coulomb friction is part of the regression (the paper's unbiased least squares) or not (simple least
/// squares).
enum class Coulomb { left_out, estimated };

/// Eqs. (20)-(25) or (28)-(40) without changes: w(k) regressed on w(k-1), u(k-1) and the signs outside the dead band.
/// Records are stacked and need a tachometer. J and B by (25), intervals by the delta method. Values are NaN if the
/// equations are singular (no motion).
RigidEstimate discrete_least_squares(const std::vector<Record>& records, const sim::DataSheet& data, double deadband,
                                     Coulomb coulomb);

/// T = J dw/dt + B w (+ T+ or T-) regressed on filtered signals, for every drive with a position or a speed.
RigidEstimate inverse_least_squares(const std::vector<Motion>& motions, Coulomb coulomb);

/// The same with Coulomb friction and a smooth curve over the travel (a cosine series of at most four waves). Without
/// this curve, gravity on an arm or a spring would bias inertia and friction. The mean of the curve is added to T+ and
/// T-.
RigidEstimate least_squares_beside_travel(const std::vector<Motion>& motions);

}  // namespace host
