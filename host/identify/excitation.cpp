#include "host/identify/excitation.hpp"

#include <algorithm>
#include <cmath>

namespace host {

std::vector<double> doublet_series(double amplitude_V, double sample_period_s) {
  constexpr double kHolds_s[] = {0.05, 0.1, 0.15, 0.2};
  constexpr double kRest_s = 0.2;
  std::vector<double> command;
  const auto hold = [&](double level_V, double duration_s) {
    const auto samples = static_cast<std::size_t>(std::lround(duration_s / sample_period_s));
    command.insert(command.end(), samples, level_V);
  };
  hold(0.0, kRest_s);
  for (const double duration_s : kHolds_s) {
    for (const double first : {amplitude_V, -amplitude_V}) {
      hold(first, duration_s);
      hold(-first, duration_s);
      hold(0.0, kRest_s);
    }
  }
  return command;
}

std::vector<Jog> jogging_programme(const std::vector<double>& speeds, double travel_per_turn, double settle_s,
                                   double longest_s) {
  std::vector<Jog> programme;
  for (const double speed : speeds) {
    const double turn_s = travel_per_turn / std::abs(speed);
    const double turns = std::floor((longest_s - settle_s) / turn_s);
    const double constant_s = turns >= 1.0 ? settle_s + std::min(turns, 3.0) * turn_s : longest_s;
    programme.push_back({std::abs(speed), constant_s});
    programme.push_back({-std::abs(speed), constant_s});
  }
  return programme;
}

}  // namespace host
