// Frequency response of a drive, from the command to position and speed, as records show it.
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
  /// Of the estimate: noise and nonlinearity together, E[e e^H].
  Eigen::Matrix2cd covariance = Eigen::Matrix2cd::Zero();
  /// Of position, or of speed where there is no position: standard deviation of the estimate by noise alone, and of
  /// what one realisation of the excitation differs from the best linear approximation by, beyond noise.
  double noise = 0.0, nonlinearity = 0.0;
  double coherence = 1.0;  ///< of command and answer; 1 where periods tell noise apart
  double degrees = 1.0;    ///< of freedom behind the covariance
};

/// What the drive answers at lines that nobody excites, between two that are excited: there noise alone is no cause.
struct DistortionLine {
  double f_Hz = 0.0;
  double level =
      0.0;  ///< root mean square, per volt of the excited lines beside it: as `plant`; 0 where noise hides it
};

/// Lines are in the order of their frequencies.
struct FrequencyResponse {
  enum class Method { periodic, welch };

  Method method = Method::periodic;
  bool is_indirect = false;  ///< against an excitation or a reference; otherwise against the command itself
  sim::DriveKind kind = sim::DriveKind::rotary;
  double sample_period_s = 0.0;
  bool has_position = false, has_speed = false;
  std::size_t realisations = 0, periods = 0;  ///< the fewest of any line
  std::vector<ResponseLine> lines;
  /// Of multisines alone. Even powers of a nonlinearity (friction that falls with speed, a drive stronger to one side)
  /// and odd ones (backlash, stiction, saturation) show apart (Pintelon & Schoukens, 2nd ed., 3.4).
  std::vector<DistortionLine> even, odd;
  std::vector<std::string> warnings;

  /// 0 position, 1 speed: what `noise` and `nonlinearity` belong to.
  Eigen::Index channel() const { return has_position ? 0 : 1; }
};

/// Of the plant in a channel: "mm/V", "rad/s/V".
std::string plant_unit(const FrequencyResponse& response, Eigen::Index channel);

/// Half width of a 95 % interval of the real part, the imaginary part or the magnitude of weights' * plant, where
/// `weights` are taken as known: Student's factor times the standard deviation of one part.
double half_width_95(const ResponseLine& line, const Eigen::Vector2cd& weights);

/// Whether weights' * plant is known well enough to build on: either part to 30 % of it. A line that falls on what the
/// machine does of itself while it rides (cogging, once a turn) is not.
bool stands_out(const ResponseLine& line, const Eigen::Vector2cd& weights);

/// The response that records of one machine show. Those that carry an excitation of whole periods (`axistool excite …
/// multisine`) are analysed by the robust method (Pintelon & Schoukens, System Identification, 2nd ed., 4.3.1):
/// averages over periods of equal lines, over realisations of their phases, and in closed loop against the excitation.
/// Others by Welch's method, against the reference where it moves, otherwise against the command. Records of both sorts
/// together are refused. Throws Failure(refused) where nothing excites the drive, Failure(bad_input) where a record has
/// no command or neither position nor speed, or where drives or sample periods differ.
FrequencyResponse frequency_response(const std::vector<Record>& records);

}  // namespace host
