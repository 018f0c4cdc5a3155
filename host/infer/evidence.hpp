// How probable measured rows are under one hypothesis: log p(y | columns), everything that is not known averaged out.
//
//   y = sum_j theta_j column_j + memory + noise
//   theta_j ~ N(0, deviation_j^2)                 what a data sheet or usual sizes say before the measurement
//   memory  = smooth functions of some coordinates, one size a coordinate, found for each hypothesis
//   noise   = first-order autoregressive with Student-t innovations of 4 degrees of freedom
//
// The memory takes what no column takes: no hypothesis wins by being the nearest to something that is none of them.
// Linear parameters are integrated in closed form (Laplace's approximation at the weights of the t distribution).
// Sources: D. MacKay, "Information Theory, Inference, and Learning Algorithms" (2003), ch. 27 and 28; Lange, Little,
// Taylor, "Robust statistical modeling using the t distribution", JASA 84 (1989) 881-896, whose data want 4 degrees.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <string>
#include <vector>

namespace host {

/// Rows [first, end) follow one another without a gap: the noise's correlation runs through them.
struct RowRun {
  Eigen::Index first, end;
};

/// Columns of the memory that lie over one coordinate and share one size.
struct MemoryGroup {
  std::string coordinate;
  Eigen::Index first, count;
};

/// Smooth functions, as columns of hats between knots. Columns are of size 1; `usual` is what their factors compare to.
struct Memory {
  Eigen::MatrixXd columns;
  std::vector<MemoryGroup> groups;
  double usual = 1.0;  ///< in the unit of y; a hundredth of it counts as nothing
};

/// One hypothesis fitted: sizes of memory and noise at their most probable, parameters with their covariance.
struct EvidenceFit {
  double log_evidence = 0.0;   ///< ln p(y | hypothesis), nats
  double correlation = 0.0;    ///< of the noise from row to row, 0 to 0.98
  double noise = 0.0;          ///< scale of the innovations, in the unit of y
  Eigen::VectorXd sizes;       ///< of each memory group, in the unit of y
  Eigen::VectorXd factors;     ///< of the hypothesis' columns
  Eigen::VectorXd remembered;  ///< what the memory takes of every row
  Eigen::VectorXd weights;     ///< of the whitened rows: 1/variance

  /// For further columns on top of these: whitened columns times their prior deviations, their information matrix's
  /// factor, and the whitened residual.
  Eigen::MatrixXd whitened;
  Eigen::LLT<Eigen::MatrixXd> information;
  Eigen::VectorXd residual;
};

/// Where a fit begins: sizes that are found can be large or small, and the better of both is kept.
struct EvidenceStart {
  double correlation = 0.5;
  Eigen::VectorXd sizes;
  bool hold_sizes = false;  ///< the sizes stay as they are
  /// A fit whose log evidence lies below this after three rounds, from where rounds change little, ends there, nats.
  double give_up = -HUGE_VAL;
};

class Evidence {
 public:
  /// `least_noise`: of the sensors alone, in the unit of y, > 0.
  Evidence(Eigen::VectorXd y, std::vector<RowRun> runs, Memory memory, double least_noise);

  /// Columns with the standard deviation that each factor has before the measurement (> 0).
  EvidenceFit fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviations, const EvidenceStart& start) const;

  /// The best of fits from a large and a small memory.
  EvidenceFit fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviations) const;
  EvidenceFit fit_from(const EvidenceFit& before, const Eigen::MatrixXd& columns, const Eigen::VectorXd& deviations,
                       double give_up = -HUGE_VAL) const;

  /// Sizes at which there is no memory.
  Eigen::VectorXd no_memory() const;

  /// Gain of the log evidence by further columns of prior deviation 1, at the noise and the memory of `fit`, for each
  /// of several common scales of these columns. `sign` of each column: +1 where its factor must not be negative, 0
  /// where it may be; -HUGE_VAL for columns that pull the wrong way.
  Eigen::VectorXd gains(const EvidenceFit& fit, const Eigen::MatrixXd& further, const std::vector<int>& sign,
                        const Eigen::VectorXd& scales) const;

  /// Each row less `correlation` times the one before it, along the runs.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns, double correlation) const;

  const Memory& memory() const { return memory_; }
  const Eigen::VectorXd& rows() const { return y_; }
  double least_noise() const { return least_noise_; }

 private:
  Eigen::VectorXd y_;
  std::vector<RowRun> runs_;
  Memory memory_;
  double least_noise_;
};

}  // namespace host
