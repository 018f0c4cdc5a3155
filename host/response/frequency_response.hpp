// Frequency response of a drive, from the command to position and speed, estimated from records.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "host/record/record.hpp"

namespace host {

/// The response at one frequency. Vectors hold position (mm/V, m/V) first and speed (rad/s/V, m/s/V) second; a channel
/// that was not recorded is 0.
struct ResponseLine {
  double f_Hz = 0.0;
  Eigen::Vector2cd plant = Eigen::Vector2cd::Zero();
  /// Covariance of the estimate by noise and nonlinearity together, E[e e^H].
  Eigen::Matrix2cd covariance = Eigen::Matrix2cd::Zero();
  /// For position (without one, for speed): standard deviation of the estimate by noise alone, and deviation of one
  /// realisation of the excitation from the best linear approximation, beyond noise.
  double noise = 0.0, nonlinearity = 0.0;
  double coherence = 1.0;  ///< between command and response; 1 if repeated periods separate the noise
  double degrees = 1.0;    ///< degrees of freedom of the covariance
};

/// Distortion: response beyond noise at lines without excitation between two excited lines.
struct DistortionLine {
  double f_Hz = 0.0;
  double level = 0.0;  ///< RMS per volt of the neighbouring excited lines, in the unit of `plant`; 0 if below the noise
};

/// Lines are sorted by frequency.
struct FrequencyResponse {
  enum class Method { periodic, welch, model };  ///< model: predicted, not measured

  Method method = Method::periodic;
  bool is_indirect = false;  ///< relative to an excitation or a reference; otherwise to the command itself
  sim::DriveKind kind = sim::DriveKind::rotary;
  double sample_period_s = 0.0;
  bool has_position = false, has_speed = false;
  std::size_t realisations = 0, periods = 0;  ///< smallest number of any line
  std::vector<ResponseLine> lines;
  /// Only for multisines. Separates even nonlinearity (friction that falls with speed, a drive that is stronger in one
  /// direction) from odd (backlash, stiction, saturation) (Pintelon & Schoukens, 2nd ed., 3.4).
  std::vector<DistortionLine> even, odd;
  std::vector<std::string> warnings;

  /// Channel of `noise` and `nonlinearity`: 0 position, 1 speed.
  Eigen::Index channel() const { return has_position ? 0 : 1; }
};

/// Unit of the plant in a channel: "mm/V", "rad/s/V".
std::string plant_unit(const FrequencyResponse& response, Eigen::Index channel);

/// Half width of the 95 % interval of the real part, the imaginary part or the magnitude of weights' * plant, with
/// exact `weights`: Student's factor times the standard deviation of one part.
double half_width_95(const ResponseLine& line, const Eigen::Vector2cd& weights);

/// Whether weights' * plant is accurate enough for a fit: real and imaginary part to 30 % of its magnitude. Lines at
/// frequencies that the moving machine itself excites (cogging, once per turn) are not.
bool stands_out(const ResponseLine& line, const Eigen::Vector2cd& weights);

/// The frequency response of the records of one machine. Records with an excitation of whole periods (`axistool excite
/// … multisine`) are analysed by the robust method (Pintelon & Schoukens, System Identification, 2nd ed., 4.3.1):
/// averages over periods of equal lines and over realisations of their phases, in closed loop relative to the
/// excitation. Other records are analysed by Welch's method, relative to the reference if it moves, otherwise to the
/// command. Throws Failure(refused) for records of both kinds together or without excitation, Failure(bad_input) for a
/// record without a command or without both position and speed, and for different drives or sampling periods.
FrequencyResponse frequency_response(const std::vector<Record>& records);

}  // namespace host
