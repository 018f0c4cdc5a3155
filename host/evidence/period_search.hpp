// Which periods over the travel a signal holds: of a screw turn, a motor turn, a pole pair, a ball - whatever they are.
#pragma once

#include <vector>

namespace host {

/// A period found in a signal over the travel.
struct PeriodPeak {
  double period;  ///< mm or m
  double cosine;  ///< least-squares amplitudes of weight * cos(2 pi x/period) and weight * sin(...)
  double sine;
  double share;  ///< part of the signal's square that the pair explains, 0..1
};

/// Signal values at travels, each to be explained as weight * harmonic(x). Several records follow one another; all
/// share the phase.
struct TravelSignal {
  std::vector<double> x;
  std::vector<double> value;
  std::vector<double> weight;
};

/// Least squares of one pair at a period; all zero where the signal cannot tell its two amplitudes apart.
PeriodPeak peak_at(const TravelSignal& signal, double period);

/// The strongest `most` peaks with periods from `shortest` to `longest`, strongest first, no two closer than the travel
/// can tell apart. The spectrum of the signal on a fine grid over the travel (FFTW) finds them; least squares refines
/// them.
std::vector<PeriodPeak> find_periods(const TravelSignal& signal, double shortest, double longest, std::size_t most);

}  // namespace host
