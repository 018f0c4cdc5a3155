// Contribution of each effect of the catalogue to the torque or force of a motion, as columns of a linear regression.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"

namespace host {

/// One effect in one form: its nonlinear parameters are fixed, its linear ones are the columns' factors.
struct EffortTerm {
  std::string kind;
  Eigen::MatrixXd columns;
  std::vector<int> sign;  ///< of each factor: +1 it must not be negative (friction opposes motion), 0 any sign
  /// Adds the effect to a model with a fitted base, by the columns' factors. False if these exceed the catalogue's
  /// bounds.
  std::function<bool(const Eigen::VectorXd& factors, sim::DriveDescription& model)> write;
  std::string words;        ///< "orders 72, 18 of 6.283 mm"; may be empty
  bool can_repeat = false;  ///< a drive may have several: waves of other periods
  /// Forms whose shape differs by this part; empty if the forms to try are close enough. Refers to the rows.
  std::function<std::vector<EffortTerm>(double part)> neighbours{};
  /// Whether the form that fits most closely is this effect and does not stand in for another; empty: it always is.
  std::function<bool(const sim::DriveDescription& fitted)> is_itself{};
  /// The effect of another kind that this form cannot be told from: of a gap that the encoder hardly resolves, the
  /// spring behind it. Empty for most. Refers to the rows.
  std::function<EffortTerm()> contained{};
  /// Prior standard deviation of the factors about 0; 0 if nothing is known of them.
  double deviation = 0.0;
  /// RMS of the torque or force that acts with this effect, over that of the logged one. The residual is expressed in
  /// this unit: where nothing acts, nothing remains to be explained.
  double acting = 1.0;
};

/// Position of these terms in a fit that also has others.
std::vector<const EffortTerm*> pointers_to(const std::vector<EffortTerm>& terms);

/// Adds an effect to a model; false if a parameter exceeds the catalogue's bounds.
bool append_within_bounds(sim::DriveDescription& model, sim::EffectEntry entry);

/// The base: inertia, viscous and Coulomb friction in the model's form, its further effects with a linear form, and the
/// time at which a logged current acts, which is no part of the model.
std::vector<EffortTerm> base_terms(const sim::DriveDescription& model, const EffortRows& rows);

/// Whether base_terms() represents the whole model.
bool has_linear_form(const sim::DriveDescription& model);

/// The model without the effects of base_terms() other than friction and inertia: effects with fixed parameters.
sim::DriveDescription standing_part(const sim::DriveDescription& model);

/// Torque or force at every row of the effects without a linear form, with the model's parameters; zero without any.
/// Requires has_inverse() of the drive.
Eigen::VectorXd standing_effort(const sim::DriveDescription& model, const EffortRows& rows);

/// All forms of the effects that could be added to the model and show while the axis slides, except waves over the
/// travel and second masses. `explained`: torque or force by the terms so far. Effects in proportion to the torque use
/// it, since the measured torque would explain itself.
std::vector<EffortTerm> shaped_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                     const Eigen::VectorXd& explained);

}  // namespace host
