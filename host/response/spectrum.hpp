// Discrete Fourier transforms of real signals.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace host {

/// Sums of x(k) e^(-j 2 pi l k / N) over k, for l = 0 .. N/2. N >= 1.
std::vector<std::complex<double>> spectrum_of(std::span<const double> x);

}  // namespace host
