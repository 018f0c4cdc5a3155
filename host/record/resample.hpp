// Even samples from uneven ones.
#pragma once

#include <vector>

namespace host {

/// A channel with time stamps of its own; both have the same length, and time increases.
struct StampedChannel {
  std::vector<double> t_s;
  std::vector<double> values;
};

/// start_s + k period_s for all k up to `end_s` (within a millionth of a period).
std::vector<double> even_grid(double start_s, double end_s, double period_s);

/// Values at the grid's times by straight lines between samples; the grid lies within the channel's stamps.
std::vector<double> interpolate(const StampedChannel& channel, const std::vector<double>& grid_s);

/// Mean over each period of a channel that is held from one sample to the next (a command at a D/A converter). Held
/// over the period, this mean moves the drive equally.
std::vector<double> mean_of_held(const StampedChannel& channel, const std::vector<double>& grid_s, double period_s);

}  // namespace host
