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
  std::vector<double> half_width;  ///< of a 95 % interval of the real part, the imaginary part or the magnitude of L
  /// L on a finer grid: from the fit times the smoothed ratio of the measured lines to it.
  std::vector<double> fine_f_Hz;
  std::vector<std::complex<double>> fine_L;
};

/// Absent if the loop does not reach the point within the measured frequencies. Gain and phase margins of an unstable
/// loop are negative.
struct LoopMargins {
  bool is_stable = true;                   ///< by Nyquist's criterion on the measured response
  std::optional<Interval95> gain_dB;       ///< allowed increase of the gain, at the lowest phase crossover
  std::optional<Interval95> phase_deg;     ///< smallest over all frequencies with |L| = 1
  std::optional<Interval95> modulus;       ///< smallest distance of L from -1; 1/max|S|
  std::optional<Interval95> crossover_Hz;  ///< lowest frequency at which |L| falls below 1
  double modulus_at_Hz = 0.0;
};

/// Throws Failure(bad_input) for different sampling periods of controller and records, or if the controller uses a
/// tachometer and the records lack the speed.
OpenLoop open_loop(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller);

/// The drive between its measured lines: the fit times the smoothed ratio of the lines to it.
struct FinePlant {
  std::vector<double> f_Hz;
  std::vector<Eigen::Vector2cd> plant;
};
FinePlant fine_plant(const FrequencyResponse& response, const PlantFit& fit);
/// The fit alone, from 0.2 Hz to close below half the sampling rate.
FinePlant fine_plant(const PlantFit& fit);

/// Margins without intervals, for a search among controllers.
LoopMargins quick_margins(const FinePlant& drive, const AxisController& controller);

/// Intervals from 200 repetitions with the uncertainty of the lines.
LoopMargins margins_of(const FrequencyResponse& response, const PlantFit& fit, const AxisController& controller);

}  // namespace host
