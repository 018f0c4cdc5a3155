// What each effect of the catalogue adds to the effort that a motion needs, as columns of a linear regression.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/effort/effort_rows.hpp"

namespace host {

/// One effect in one form: its non-linear parameters stand, its linear ones are the columns' factors.
struct EffortTerm {
  std::string kind;
  Eigen::MatrixXd columns;
  std::vector<int> sign;  ///< of each factor: +1 it must not be negative (friction opposes motion), 0 it may be both
  /// Turns a model with a fitted base into one that has the effect, by the columns' factors. False where these are out
  /// of the catalogue's bounds.
  std::function<bool(const Eigen::VectorXd& factors, sim::DriveDescription& model)> write;
  std::string words;        ///< "orders 72, 18 of 6.283 mm"; may be empty
  bool can_repeat = false;  ///< a drive may have several of it: waves of other periods
  /// Forms whose shape differs by this part; empty where the forms that are tried lie close enough. It refers to the
  /// rows.
  std::function<std::vector<EffortTerm>(double part)> neighbours{};
  /// RMS of the effort that acts with this effect, over that of the logged one. What is left is measured in that: where
  /// nothing acts, nothing is left, and nothing is explained.
  double acting = 1.0;
};

/// Where the terms are, for a fit that takes further ones.
std::vector<const EffortTerm*> pointers_to(const std::vector<EffortTerm>& terms);

/// Adds an effect to a model; false where a parameter is out of the catalogue's bounds.
bool append_within_bounds(sim::DriveDescription& model, sim::EffectEntry entry);

/// The base: inertia, viscous and Coulomb friction in the form that the model has, and the effects that it holds
/// already, as far as they have a linear form.
std::vector<EffortTerm> base_terms(const sim::DriveDescription& model, const EffortRows& rows);

/// Whether base_terms() can stand for the whole model.
bool has_linear_form(const sim::DriveDescription& model);

/// The model without the effects of base_terms() that are not friction or inertia: what acts as it stands.
sim::DriveDescription standing_part(const sim::DriveDescription& model);

/// Effort that the effects without a linear form take at every row, as they stand in the model; zero where there are
/// none. Requires has_inverse() of the drive.
Eigen::VectorXd standing_effort(const sim::DriveDescription& model, const EffortRows& rows);

/// All forms of the effects that could be added to the model and leave a trace while the axis slides, but for waves
/// over the travel and second masses. `explained` is the effort by the terms so far: what is in proportion to the
/// effort is taken in proportion to that, since the measured one would explain itself.
std::vector<EffortTerm> shaped_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                     const Eigen::VectorXd& explained);

}  // namespace host
