// Noise that is correlated from row to row, plus white noise.
//
//   noise = d + r,   d_k = phi d_{k-1} + q_k,   r white
//
// is the same as one series of innovations e (C. W. J. Granger, M. J. Morris, "Time series modelling and
// interpretation", J. R. Statist. Soc. A 139 (1976) 246-257):
//
//   noise_k = phi noise_{k-1} + e_k - psi e_{k-1},   0 <= psi <= phi
#pragma once

#include <Eigen/Core>
#include <vector>

namespace host {

/// Rows [first, end) are consecutive, so their noise is correlated.
struct RowRun {
  Eigen::Index first, end;
};

struct NoiseColour {
  double drift = 0.0;  ///< phi: part of the drift that remains one row later, 0 to 0.98
  double white = 0.0;  ///< psi: 0 if there is no white noise, phi if all noise is white

  /// Correlation between one row and the next.
  double from_row_to_row() const {
    return (drift - white) * (1.0 - drift * white) / (1.0 - 2.0 * drift * white + white * white);
  }
  /// Standard deviation of the innovations over that of the noise, 0 to 1.
  double innovation() const;

  /// The innovations of each column along the runs.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns, const std::vector<RowRun>& runs) const;
};

/// The candidate colours of the noise.
enum class NoiseKind { drift, drift_and_white };

/// The colour with the smallest weighted sum of squared innovations.
NoiseColour colour_of(NoiseKind kind, const Eigen::VectorXd& noise, const Eigen::VectorXd& weights,
                      const std::vector<RowRun>& runs);

}  // namespace host
