// Torque or force that each effect of the catalogue contributes to a motion, as columns of a linear regression.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"

namespace host {

/// One effect in one form: its nonlinear parameters are fixed, and its linear parameters are the factors of the
/// columns.
struct EffortTerm {
  std::string kind;
  Eigen::MatrixXd columns;
  std::vector<int> sign;  ///< of each factor: +1 if it must be >= 0 (friction opposes motion), 0 for any sign
  /// Adds the effect to a model with a fitted base, from the factors of the columns. False if it exceeds the bounds of
  /// the catalogue.
  std::function<bool(const Eigen::VectorXd& factors, sim::DriveDescription& model)> write;
  std::string words;        ///< "orders 72, 18 of 6.283 mm"; may be empty
  bool can_repeat = false;  ///< a drive may have several of them: waves with other periods
  /// Makers of similar forms, whose shape differs by this part. Empty if the forms that are tried are close enough.
  /// Refers to the rows.
  std::function<std::vector<std::function<EffortTerm()>>(double part)> neighbours{};
  /// Whether the closest form is this effect and does not stand in for another. If empty, it always is.
  std::function<bool(const sim::DriveDescription& fitted)> is_itself{};
  /// The effect of another kind that these rows cannot tell from this form: for a gap that the encoder hardly resolves,
  /// the spring. Empty for most forms. Refers to the rows.
  std::function<EffortTerm()> contained{};
  /// Prior standard deviation of the factors about 0; 0 if there is no prior.
  double deviation = 0.0;
  /// RMS of the torque or force that acts with this effect, relative to that of the logged torque or force. The
  /// residual is relative to the torque or force that acts.
  double acting = 1.0;
};

/// Pointers to these terms, for a fit that also has others.
std::vector<const EffortTerm*> pointers_to(const std::vector<EffortTerm>& terms);

/// Adds an effect to a model; false if a parameter exceeds the catalogue's bounds.
bool append_within_bounds(sim::DriveDescription& model, sim::EffectEntry entry);

/// Coulomb friction of the model, mean of both directions, Nm or N; without the factors of an asymmetry.
double coulomb_level(const sim::DriveDescription& model);

/// The terms of the base: inertia, viscous and Coulomb friction in the model's form, the model's further effects with a
/// linear form, and the time offset of a logged current, which is not part of the model.
std::vector<EffortTerm> base_terms(const sim::DriveDescription& model, const EffortRows& rows);

/// Whether base_terms() represents the whole model.
bool has_linear_form(const sim::DriveDescription& model);

/// The effects of the model that have no term in base_terms(), and its friction and inertia. The parameters of these
/// effects stay fixed.
sim::DriveDescription standing_part(const sim::DriveDescription& model);

/// Torque or force at every row from the effects without a linear form, with the model's parameters; zero if there are
/// none. The drive must fulfil has_inverse().
Eigen::VectorXd standing_effort(const sim::DriveDescription& model, const EffortRows& rows);

/// All forms of the effects that can be added to the model and show while the axis slides, except waves over the travel
/// and second masses. `explained`: torque or force of the terms so far. Effects in proportion to the torque use it,
/// because the measured torque would explain itself.
std::vector<EffortTerm> shaped_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                     const Eigen::VectorXd& explained);

}  // namespace host
