// Selects the next effect by Bayesian evidence: every form of every effect is a set of columns of the force balance.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"
#include "host/effort/effort_terms.hpp"
#include "host/effort/next_effects.hpp"
#include "host/infer/evidence.hpp"

namespace host {

/// Training error of a form beside the effects chosen before; empty if the fit exceeds physical bounds.
using PlainFit = std::function<std::optional<double>(const EffortTerm&)>;

/// The force balance of one drive, with terms for the base and for the effects chosen so far.
class EffortHypotheses {
 public:
  /// `absent`: kinds that next() excludes. `coulomb`: the drive's friction level, Nm or N; all usual sizes are relative
  /// to it. Keeps references to model and rows.
  EffortHypotheses(const sim::DriveDescription& model, const EffortRows& rows, const std::vector<EffortTerm>& base,
                   const Eigen::VectorXd& explained, double coulomb, const std::vector<std::string>& absent);

  /// Fits all kinds except `excluded` in addition to the terms chosen so far.
  NextEffects next(const std::vector<EffortTerm>& chosen, const Eigen::VectorXd& explained,
                   const std::vector<std::string>& excluded, const PlainFit& plain_fit) const;

  /// ln of the evidence (marginal likelihood) of the rows for the base and these terms.
  double log_evidence(const std::vector<EffortTerm>& chosen) const;

  /// ln of the odds that a memory is needed beside the chosen terms, which means that the residual depends on a
  /// coordinate.
  double memory_log_odds(const EvidenceFit& fit, const std::vector<EffortTerm>& chosen) const;

  /// Weight of each row in a fit, 0 (outlier) to 1.
  Eigen::VectorXd weights(const EvidenceFit& fit) const;

  const Memory& memory() const { return evidence_.memory(); }

 private:
  struct Known {
    Eigen::MatrixXd columns;
    Eigen::VectorXd deviations;
    void add(const Eigen::VectorXd& column, double deviation);
  };
  Known known_with(const std::vector<EffortTerm>& chosen) const;

  const sim::DriveDescription& model_;
  const EffortRows& rows_;
  ThinnedRows thin_;
  std::vector<EffortTerm> second_masses_;
  Known base_;
  double coulomb_;
  Evidence evidence_;
};

}  // namespace host
