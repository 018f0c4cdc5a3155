#include "host/response/spectrum.hpp"

#include <fftw3.h>

#include <mutex>

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

}  // namespace host
