// Bayesian evidence of one hypothesis for measured rows: log p(y | columns), integrated over all unknowns.
//
//   y = sum_j theta_j column_j + memory + noise
//   theta_j ~ N(0, deviation_j^2)                 prior from a data sheet or usual sizes
//   memory  = smooth functions of some coordinates, one size per coordinate, estimated for each hypothesis
//   noise   = drift, or drift and white noise (noise_colour.hpp), with Student-t innovations of 4 degrees of freedom
//
// The memory models the part that no column explains (model discrepancy). Without it, a hypothesis could win only
// because it is closest to an unknown effect. Linear parameters are integrated in closed form (Laplace's approximation
// at the weights of the t distribution). Sources: D. MacKay, "Information Theory, Inference, and Learning Algorithms"
// (2003), ch. 27 and 28; Lange, Little, Taylor, "Robust statistical modeling using the t distribution", JASA 84 (1989)
// 881-896, whose data give 4 degrees of freedom.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <string>
#include <vector>

#include "host/infer/noise_colour.hpp"

namespace host {

/// Columns of the memory over one coordinate, with a common size.
struct MemoryGroup {
  std::string coordinate;
  Eigen::Index first, count;
};

/// Smooth functions as columns of hat functions between knots. The columns have size 1; `usual` is the scale of their
/// factors.
struct Memory {
  Eigen::MatrixXd columns;
  std::vector<MemoryGroup> groups;
  double usual = 1.0;  ///< in the unit of y; a hundredth of it counts as zero
};

/// One fitted hypothesis: most probable sizes of memory and noise, and parameters with their covariance.
struct EvidenceFit {
  double log_evidence = 0.0;   ///< ln p(y | hypothesis), nats
  NoiseColour colour;          ///< correlation of the noise between rows
  double noise = 0.0;          ///< scale of the innovations, in the unit of y
  Eigen::VectorXd sizes;       ///< size of each memory group, in the unit of y
  Eigen::VectorXd factors;     ///< factors of the hypothesis' columns
  Eigen::VectorXd remembered;  ///< part of every row that the memory explains
  Eigen::VectorXd weights;     ///< weights of the whitened rows: 1/variance

  /// For gains(), which adds further columns: whitened columns times their prior standard deviations, the Cholesky
  /// factor of their information matrix, and the whitened residual.
  Eigen::MatrixXd whitened;
  Eigen::LLT<Eigen::MatrixXd> information;
  Eigen::VectorXd residual;
};

/// Start of a fit. The sizes that result may be large or small, depending on the start; the better fit is kept.
struct EvidenceStart {
  NoiseColour colour = {.drift = 0.5};
  Eigen::VectorXd sizes;
  bool hold_sizes = false;  ///< true if the sizes stay fixed
  /// Log evidence, nats. A fit ends if it is below this after three rounds and further rounds change little.
  double give_up = -HUGE_VAL;
};

class Evidence {
 public:
  /// `least_noise`: noise of the sensors alone, in the unit of y, > 0.
  Evidence(Eigen::VectorXd y, std::vector<RowRun> runs, Memory memory, double least_noise,
           NoiseKind kind = NoiseKind::drift);

  /// `deviations`: prior standard deviation of the factor of each column, > 0.
  EvidenceFit fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviations, const EvidenceStart& start) const;

  /// The better of two fits, one starting with a large memory and one with a small memory.
  EvidenceFit fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviations) const;
  EvidenceFit fit_from(const EvidenceFit& before, const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviations,
                       double give_up = -HUGE_VAL) const;

  /// Sizes for a fit without a memory.
  Eigen::VectorXd no_memory() const;

  /// Gain of log evidence by further columns with prior standard deviation 1, with the noise and the memory of `fit`,
  /// for each of several common scales of these columns. `sign` of each column: +1 if its factor must not be negative,
  /// 0 if it may be. -HUGE_VAL if a factor has the wrong sign.
  Eigen::VectorXd gains(const EvidenceFit& fit, const Eigen::MatrixXd& further, const std::vector<int>& sign,
                        const Eigen::VectorXd& scales) const;

  /// The innovations of each column along the runs of rows.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns, const NoiseColour& colour) const {
    return colour.whiten(columns, runs_);
  }

  const Memory& memory() const { return memory_; }
  const Eigen::VectorXd& rows() const { return y_; }
  double least_noise() const { return least_noise_; }

 private:
  Eigen::VectorXd y_;
  std::vector<RowRun> runs_;
  Memory memory_;
  double least_noise_;
  NoiseKind kind_;
};

}  // namespace host
