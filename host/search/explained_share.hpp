// How much of an error a model explains, and when nothing is left to explain.
#pragma once

namespace host {

/// Error of a complete model over its noise floor: simulated cases without an effect give 0.8 to 1.05.
inline constexpr double kComplete = 1.0;

/// Combined error above which something remains to be explained; a perfect model gives about 1.
inline constexpr double kExplained = 1.25;

/// Two models predict equally well if their errors differ by a smaller factor.
inline constexpr double kAsGood = 1.1;

/// Explained share of the explainable squared error, before^2 - kComplete^2; 0..1. 0 if nothing is explainable.
double explained_share(double before, double after);

}  // namespace host
