// One sine over the travel.
#pragma once

#include <cmath>
#include <numbers>

namespace sim {

/// cosine * cos(2 pi x / period) + sine * sin(2 pi x / period); the constructor's period must not be 0.
class Harmonic {
 public:
  Harmonic(double cosine, double sine, double period)
      : cosine_(cosine), sine_(sine), wavenumber_(2.0 * std::numbers::pi / period) {}

  double operator()(double x) const { return cosine_ * std::cos(wavenumber_ * x) + sine_ * std::sin(wavenumber_ * x); }

 private:
  double cosine_, sine_, wavenumber_;
};

}  // namespace sim
