// Physical relations between channels, which test the meaning of their names.
#pragma once

#include <optional>
#include <vector>

namespace host {

/// y = factor * x + constant, least squares.
struct Proportion {
  double factor = 0.0;
  double r_squared = 0.0;  ///< share of the variance of y that x explains
  double deviation = 0.0;  ///< standard deviation of the factor
};

/// The factor by which the change of `position` is the time integral of `speed`, over intervals of several rows
/// (encoder steps would dominate the difference of a single row). Empty if one of them does not change or has gaps.
std::optional<Proportion> change_over_speed(const std::vector<double>& position, const std::vector<double>& speed,
                                            double period_s);

/// Long-term relation of `measured` to `reference` (means over a tenth of the rows): measured = factor * reference +
/// terms in the speed and acceleration of the reference. Empty if one of them does not change.
std::optional<Proportion> follows(const std::vector<double>& measured, const std::vector<double>& reference);

/// The share of the variance of `effort` that acceleration, speed and direction of a motion explain, 0 to 1. `position`
/// may have any unit.
std::optional<double> effort_by_motion(const std::vector<double>& position, const std::vector<double>& effort);

/// The range at which a position wraps (a turn, 2^16 counts), in its own unit. It must jump at least twice by nearly
/// the same distance, which is more than half of its range. Empty if it does not wrap.
std::optional<double> wrap_range(const std::vector<double>& position);

/// Whether all values are whole numbers and there are more than a few different ones; a position is then in counts.
bool are_whole(const std::vector<double>& values);

/// The sign bit of numbers in sign-magnitude form that were read as unsigned (15: 32968 is -200). Empty if there is no
/// evidence of that form.
std::optional<int> sign_bit(const std::vector<double>& values);

/// The values with `bit` as sign bit.
std::vector<double> without_sign_bit(std::vector<double> values, int bit);

}  // namespace host
