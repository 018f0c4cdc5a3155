#include "host/response/distortion.hpp"

#include <algorithm>
#include <cmath>

namespace host {

namespace {

using Complex = std::complex<double>;
using Samples = std::vector<std::vector<PeriodicRun::Sample>>;  // [period][line]

/// Power at one line that repeats from period to period, minus the noise in it.
double repeated_power(const Samples& samples, std::size_t at, Complex plant, Eigen::Index channel) {
  const double periods = static_cast<double>(samples.size());
  std::vector<Complex> rest;
  Complex mean = 0.0;
  for (const auto& period : samples) {
    const PeriodicRun::Sample& sample = period[at];
    rest.push_back((channel == 0 ? sample.x : sample.w) - plant * sample.u);
    mean += rest.back() / periods;
  }
  double spread = 0.0;
  for (const Complex one : rest) spread += std::norm(one - mean);
  return std::norm(mean) - spread / (periods * (periods - 1.0));
}

/// The response between two lines, interpolated over the logarithm of the frequency.
Complex between(const ResponseLine& below, const ResponseLine& above, double f_Hz, Eigen::Index channel) {
  const double part = std::log(f_Hz / below.f_Hz) / std::log(above.f_Hz / below.f_Hz);
  return below.plant(channel) * std::exp(part * std::log(above.plant(channel) / below.plant(channel)));
}

class Gaps {
 public:
  Gaps(const std::vector<PeriodicRun>& runs, const std::vector<ResponseLine>& lines, Eigen::Index channel)
      : runs_(runs), lines_(lines), channel_(channel) {}

  std::vector<DistortionLine> of(std::vector<std::size_t> PeriodicRun::*at, Samples PeriodicRun::*samples) const {
    const std::vector<std::size_t>& excited = runs_.front().excitation.lines;
    const std::vector<std::size_t>& detecting = runs_.front().*at;
    std::vector<DistortionLine> found;
    for (std::size_t gap = 0; gap + 1 < excited.size(); ++gap) {
      double power = 0.0, sum_Hz = 0.0, count = 0.0;
      for (std::size_t i = 0; i < detecting.size(); ++i) {
        if (detecting[i] < excited[gap] || detecting[i] > excited[gap + 1]) continue;
        const double f_Hz = frequency(detecting[i]);
        const Complex plant = between(lines_[gap], lines_[gap + 1], f_Hz, channel_);
        for (const PeriodicRun& run : runs_) power += repeated_power(run.*samples, i, plant, channel_);
        sum_Hz += f_Hz;
        ++count;
      }
      if (count == 0.0) continue;
      const double mean = power / (count * static_cast<double>(runs_.size()));
      found.push_back({sum_Hz / count, std::sqrt(std::max(0.0, mean) / command_power(gap))});
    }
    return found;
  }

 private:
  double frequency(std::size_t line) const {
    const PeriodicRun& run = runs_.front();
    return static_cast<double>(line) / (static_cast<double>(run.excitation.period) * run.sample_period_s);
  }

  /// Mean power of the excited lines on both sides of a gap.
  double command_power(std::size_t gap) const {
    double sum = 0.0, count = 0.0;
    for (const PeriodicRun& run : runs_)
      for (const auto& period : run.period)
        for (const std::size_t line : {gap, gap + 1}) {
          sum += std::norm(period[line].u);
          ++count;
        }
    return sum / count;
  }

  const std::vector<PeriodicRun>& runs_;
  const std::vector<ResponseLine>& lines_;
  Eigen::Index channel_;
};

}  // namespace

Distortion distortion_of(const std::vector<PeriodicRun>& runs, const std::vector<ResponseLine>& lines,
                         Eigen::Index channel) {
  const Gaps gaps(runs, lines, channel);
  return {gaps.of(&PeriodicRun::even_lines, &PeriodicRun::even), gaps.of(&PeriodicRun::odd_lines, &PeriodicRun::odd)};
}

}  // namespace host
