// Budgets of the fits in a search, and the windows that such a budget allows.
#pragma once

#include "host/fit/model_fit.hpp"

namespace host {

/// A drive with one integrator step per sample needs at most a third of these budgets. So a resonance of 200 Hz at 1
/// kHz (five steps per sample) still gets as many passes as most fits take. All fits of a search together take at most
/// some 400 million steps.
inline constexpr FitOptions kFirstLook{.most_iterations = 7, .least_gain = 1e-3, .most_steps = 8e6};
inline constexpr FitOptions kSeriousFit{.most_iterations = 12, .least_gain = 3e-4, .most_steps = 8e6};
inline constexpr FitOptions kLastWord{.most_iterations = 12, .least_gain = 3e-5, .most_steps = 20e6};

/// Numbers of windows of kWindow_s for the first look, the serious fits and the final comparison.
struct WindowCounts {
  std::size_t coarse = 80;
  std::size_t medium = 200;
  std::size_t final = 600;

  /// The numbers of windows of another length that contain as many samples in total.
  WindowCounts over(double window_s) const;
};

/// The set with about this many windows in use, spread evenly over the records.
RecordSet thinned(const RecordSet& set, std::size_t windows);

/// The set with so few windows in use that the budget of a fit of `model` suffices, but at least ten windows.
RecordSet affordable(const RecordSet& set, const sim::DriveDescription& model, const FitOptions& options);

}  // namespace host
