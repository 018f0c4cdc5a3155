// What channels must have to do with each other if they are what their names say.
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

/// The factor by which the change of `position` is the time integral of `speed`, over stretches of `stretch` rows (a
/// row's difference would drown in the encoder's steps). Empty where one of them stands still or holds gaps.
std::optional<Proportion> change_over_speed(const std::vector<double>& position, const std::vector<double>& speed,
                                            double period_s);

/// How `measured` follows `reference` in the long run (means over a tenth of the rows): measured = factor * reference +
/// what grows with its speed and acceleration. Empty where one of them stands still.
std::optional<Proportion> follows(const std::vector<double>& measured, const std::vector<double>& reference);

/// The share of the effort's variance that acceleration, speed and direction of a motion explain (0 to 1). `position`
/// in any unit.
std::optional<double> effort_by_motion(const std::vector<double>& position, const std::vector<double>& effort);

/// The range after which a position begins again (a turn, 2^16 counts), in its own unit: where it jumps by more than
/// half of what it covers, twice at least and always by nearly as much. Empty where it does not.
std::optional<double> wrap_range(const std::vector<double>& position);

/// Whether all values are whole numbers over more than a few: counts, if it is a position.
bool are_whole(const std::vector<double>& values);

/// Numbers of a sign and a magnitude that were read as one whole number: the bit (15: 32968 is -200). Empty where there
/// is no sign of it.
std::optional<int> sign_bit(const std::vector<double>& values);

/// The values that `bit` gives.
std::vector<double> without_sign_bit(std::vector<double> values, int bit);

/// Whether all finite values are the same.
bool is_constant(const std::vector<double>& values);

}  // namespace host
