// Causes of circle errors, ranked, each with its share in micrometres, from one linear model of signatures.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/axes/circle_signatures.hpp"

namespace host {

struct CircleFinding {
  CircleCause cause;
  Eigen::VectorXd factors;
  /// Contribution of this cause alone to the bi-directional circular deviation: largest minus smallest radial
  /// deviation.
  double um = 0.0;
  std::array<double, 2> ci95{};
  double amount = 0.0;                   ///< in the cause's own unit; for waves and spikes the largest amplitude
  std::optional<double> period_turns{};  ///< period in turns of the motor
  double probability = 0.0;              ///< probability against no cause and against all alternatives
  std::vector<std::pair<std::string, double>> instead;  ///< alternative causes with their probabilities
};

/// Terms of ISO 230-4, from the outer sensor if there is one, otherwise from the encoders; means over 1 degree.
struct CircleFigures {
  double G_um = 0.0;                      ///< circular deviation: largest minus smallest radius about the best centre
  double F_max_um = 0.0, F_min_um = 0.0;  ///< radial deviation from the nominal circle
};
struct BidirectionalFigures {
  double Gb_um = 0.0;  ///< circular deviation of both directions together
  double H_um = 0.0;   ///< hysteresis: largest difference of the radii of both directions at one angle
};

struct CircleDiagnosis {
  std::vector<CirclePass> passes;
  std::vector<CircleFinding> causes;  ///< the largest first
  std::vector<CircleFinding> minor;   ///< minor causes: at most a twentieth of the deviation
  std::vector<Unseen> unseen;
  double rest_um = 0.0;                      ///< RMS of the unexplained residual beyond noise
  std::vector<CircleFigures> figures;        ///< of each pass
  std::optional<BidirectionalFigures> both;  ///< the worst feed; absent with one direction only
};

CircleDiagnosis diagnose_circle(std::vector<CirclePass> passes);

/// Adds the periods in turns of the motor for the model's axis. Throws Failure(usage), naming `path`, for a model
/// of another axis than x or y.
void tell_turns(CircleDiagnosis& diagnosis, const sim::DriveDescription& model, const std::string& path);

/// Radial deviation by a cause along a pass, um, at its samples.
std::vector<double> share_along(const CircleFinding& finding, const CirclePass& pass);

/// `axis-circle/1`.
nlohmann::json circle_json(const CircleDiagnosis& diagnosis);

}  // namespace host
