// Open loop, sensitivity and stability margins of a measured drive with a controller.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "host/response/axis_controller.hpp"
#include "host/response/frequency_response.hpp"
#include "host/response/plant_fit.hpp"

namespace host {

/// The open loop L, cut at the drive's input, at the measured lines and, between them, along the fit.
struct OpenLoop {
  std::vector<double> f_Hz;
  std::vector<std::complex<double>> L;
  std::vector<double> half_width;  ///< of a 95 % interval of either part of L, or of its magnitude
  /// Finer: the fit, times the measured lines' ratio to it.
  std::vector<double> fine_f_Hz;
  std::vector<std::complex<double>> fine_L;
};

/// Absent where the loop does not get there within the measured frequencies. Of an unstable loop, gain and phase are
/// negative: what is missing.
struct LoopMargins {
  bool is_stable = true;                   ///< by Nyquist's criterion on the measured response
  std::optional<Interval95> gain_dB;       ///< by which the gain may rise, at the lowest such frequency
  std::optional<Interval95> phase_deg;     ///< the least, of all frequencies where |L| = 1
  std::optional<Interval95> modulus;       ///< least distance of L from -1; 1/max|S|
  std::optional<Interval95> crossover_Hz;  ///< lowest frequency at which |L| falls below 1
  double modulus_at_Hz = 0.0;
};

/// Throws Failure(bad_input) where controller and records have different sample periods, or the controller uses a
/// tachometer whose speed the records lack.
OpenLoop open_loop(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller);

/// The drive between its lines: the fit, times the measured lines' smoothed ratio to it.
struct FinePlant {
  std::vector<double> f_Hz;
  std::vector<Eigen::Vector2cd> plant;
};
FinePlant fine_plant(const FrequencyResponse& response, const PlantFit& fit);
/// The fit alone, from 0.2 Hz to close below half the sampling rate.
FinePlant fine_plant(const PlantFit& fit);

/// Margins whose intervals have no width, for a search among controllers.
LoopMargins quick_margins(const FinePlant& drive, const AxisController& controller);

/// Intervals come from 200 repetitions with the lines' own uncertainty.
LoopMargins margins_of(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller);

}  // namespace host
