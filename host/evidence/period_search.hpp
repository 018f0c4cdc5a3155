// Finds periods of a signal over the travel, for example of a screw turn, a motor turn, a pole pair or a ball.
#pragma once

#include <vector>

namespace host {

/// A period found in a signal over the travel.
struct PeriodPeak {
  double period;  ///< mm or m
  double cosine;  ///< least-squares amplitudes of weight * cos(2 pi x/period) and weight * sin(...)
  double sine;
  double share;  ///< part of the squared signal that this pair explains, 0 to 1
};

/// Signal values over the travel. Each is modelled as weight * harmonic(x). The values of several records follow one
/// another and share the phase.
struct TravelSignal {
  std::vector<double> x;
  std::vector<double> value;
  std::vector<double> weight;
};

/// Least squares of one pair of amplitudes at a period; all zero if the signal does not determine both.
PeriodPeak peak_at(const TravelSignal& signal, double period);

/// The strongest `most` peaks with periods from `shortest` to `longest`, strongest first, with a distance of at least
/// one resolution of the travel. FFTW computes the spectrum of the signal on a fine grid over the travel; least squares
/// refines the peaks.
std::vector<PeriodPeak> find_periods(const TravelSignal& signal, double shortest, double longest, std::size_t most);

}  // namespace host
