#include "host/fourier.hpp"

#include <fftw3.h>

#include <cmath>
#include <mutex>
#include <numbers>

namespace host {

std::vector<std::complex<double>> spectrum_of(std::span<const double> x) {
  static std::mutex planner;  // FFTW's planner is not re-entrant
  std::vector<double> in(x.begin(), x.end());
  std::vector<std::complex<double>> out(x.size() / 2 + 1);
  fftw_plan plan = nullptr;
  {
    const std::lock_guard lock(planner);
    plan = fftw_plan_dft_r2c_1d(static_cast<int>(in.size()), in.data(), reinterpret_cast<fftw_complex*>(out.data()),
                                FFTW_ESTIMATE);
  }
  fftw_execute(plan);
  {
    const std::lock_guard lock(planner);
    fftw_destroy_plan(plan);
  }
  return out;
}

std::vector<double> hann_window(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t k = 0; k < length; ++k)
    window[k] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
  return window;
}

}  // namespace host
