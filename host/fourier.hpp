// Discrete Fourier transforms of real signals. Only this file calls FFTW, whose planner is not re-entrant.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace host {

/// Sums of x(k) e^(-j 2 pi l k / N) over k, for l = 0 .. N/2. N >= 1. Any number of threads may call it at once.
std::vector<std::complex<double>> spectrum_of(std::span<const double> x);

/// (1 - cos(2 pi k / length)) / 2 for k = 0 .. length - 1: the window of Welch's method (Welch 1967, Harris 1978).
std::vector<double> hann_window(std::size_t length);

}  // namespace host
