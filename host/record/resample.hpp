// Makes evenly spaced samples from unevenly spaced ones.
#pragma once

#include <vector>

namespace host {

/// A channel with its own time stamps. Both vectors have the same length, and time increases.
struct StampedChannel {
  std::vector<double> t_s;
  std::vector<double> values;
};

/// start_s + k period_s for all k, up to `end_s` (within a millionth of a period).
std::vector<double> even_grid(double start_s, double end_s, double period_s);

/// Linearly interpolated values at the times of the grid, which must lie within the stamps of the channel.
std::vector<double> interpolate(const StampedChannel& channel, const std::vector<double>& grid_s);

/// Mean over each period of a channel that is held from one sample to the next (a command at a D/A converter). Held
/// over the period, this mean causes the same motion of the drive.
std::vector<double> mean_of_held(const StampedChannel& channel, const std::vector<double>& grid_s, double period_s);

}  // namespace host
