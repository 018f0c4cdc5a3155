// Which effect comes next, by evidence: every form of every effect as columns of the force balance.
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

/// Plain training error of a form beside what was chosen before; nothing where it has no room within physics.
using PlainFit = std::function<std::optional<double>(const EffortTerm&)>;

/// The force balance of one drive, with what is fitted in every hypothesis: base and effects chosen so far.
class EffortHypotheses {
 public:
  /// `absent`: kinds that next() will not be asked for. `coulomb`: the drive's friction level, Nm or N, to which all
  /// usual sizes compare. Keeps references to model and rows.
  EffortHypotheses(const sim::DriveDescription& model, const EffortRows& rows, const std::vector<EffortTerm>& base,
                   const Eigen::VectorXd& explained, double coulomb, const std::vector<std::string>& absent);

  /// Fits all kinds but those `excluded` beside the terms chosen so far.
  NextEffects next(const std::vector<EffortTerm>& chosen, const Eigen::VectorXd& explained,
                   const std::vector<std::string>& excluded, const PlainFit& plain_fit) const;

  /// ln p of the rows with these terms beside the base.
  double log_evidence(const std::vector<EffortTerm>& chosen) const;

  /// ln of the odds that a memory is needed beside the chosen terms: something depends on a coordinate.
  double memory_log_odds(const EvidenceFit& fit, const std::vector<EffortTerm>& chosen) const;

  /// How far a fit takes each row for no outlier, 0 to 1.
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
