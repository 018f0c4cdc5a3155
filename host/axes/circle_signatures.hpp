// What each cause of a bad circle leaves in the radial deviation: columns of one linear model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/axes/circle_pass.hpp"

namespace host {

/// Rows of one pass as one sensor saw it.
struct CircleBlock {
  std::size_t pass;
  bool is_outer;
  Eigen::Index first, end;
  double weight;  ///< 1 / noise, 1/um: rows of every sensor have noise of size 1
};

/// All rows of all passes and sensors, each the mean of some samples.
class CircleRows {
 public:
  explicit CircleRows(const std::vector<CirclePass>& passes);

  /// Of a pass and a sample, um.
  using Signature = std::function<double(const CirclePass& pass, std::size_t sample)>;
  /// As rows, times their weights; 0 in rows of the encoders where `outer_only`.
  Eigen::VectorXd column(const Signature& signature, bool outer_only) const;
  /// The same for each block on its own.
  Eigen::VectorXd block_column(const Signature& signature, const CircleBlock& block) const;

  const Eigen::VectorXd& deviation() const { return deviation_; }
  const std::vector<CirclePass>& passes() const { return passes_; }
  const std::vector<CircleBlock>& blocks() const { return blocks_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Of the middle of a row.
  const Eigen::VectorXd& angle_rad() const { return angle_; }
  const Eigen::VectorXd& time_s() const { return time_; }
  bool has_outer() const { return has_outer_; }
  /// Time that a row of a pass spans; of the fastest pass.
  double row_s(std::size_t pass) const { return static_cast<double>(samples_a_row_[pass]) * passes_[pass].period_s; }
  double row_s() const { return row_s_; }

 private:
  void add(std::size_t pass, bool is_outer);

  const std::vector<CirclePass>& passes_;
  std::vector<CircleBlock> blocks_;
  std::vector<std::size_t> samples_a_row_;  ///< of each pass
  Eigen::VectorXd deviation_, weights_, angle_, time_;
  bool has_outer_ = false;
  double row_s_ = 0.0;
};

/// One cause with its values of a nonlinear parameter filled in.
struct CircleCause {
  std::string kind, axis;  ///< axis: "x", "y", "xy"
  std::vector<CircleRows::Signature> signatures;
  bool outer_only = false;     ///< the encoders do not see it
  Eigen::MatrixXd columns;     ///< the signatures as rows
  Eigen::VectorXd deviations;  ///< of the factors before the measurement, um
  double log_prior = 0.0;
  std::optional<double> period_mm, frequency_Hz;
  /// What a factor of 1 um is in the cause's own unit: ms, um/m, ppm; empty where um it is.
  double amount_per_um = 1.0;
  std::string amount_unit = "um";
};

/// Cycles of a wave that a row of the fastest pass may span and still show it.
inline constexpr double kMostCyclesARow = 0.4;
/// Whether the mean over rows of a pass leaves something of a wave: also as an alias, which its signature then shows.
bool shows_through(double frequency_Hz, double row_s);

enum class WaveKind { cyclic_error, torque_ripple, vibration };

/// Causes without a nonlinear parameter, and reversal spikes with each of several decay times: everything that these
/// sensors can see.
std::vector<CircleCause> plain_causes(const CircleRows& rows);

/// A wave over the travel of an axis (value: its period, mm) or over time (frequency, Hz).
CircleCause wave_cause(const CircleRows& rows, WaveKind kind, char axis, double value);

/// Torque ripple near the loop's own frequency, where a series in the frequency does not follow the loop's answer.
CircleCause ripple_through_any_loop(const CircleRows& rows, char axis, double period_mm);

/// The wave of this kind over this axis that fits what is left best, by a grid of periods or frequencies. `left`: rows
/// times their weights.
CircleCause best_wave(const CircleRows& rows, const Eigen::VectorXd& left, WaveKind kind, char axis);
/// The same near the wave that is there.
CircleCause nearby_wave(const CircleRows& rows, const Eigen::VectorXd& left, const CircleCause& wave);

/// Kinds that these sensors and passes cannot see or tell apart, with the reason and what would show them.
struct Unseen {
  std::string kind, why;
};
std::vector<Unseen> unseen_causes(const CircleRows& rows);

/// Meaning, and what to do about it.
struct CauseText {
  const char *title, *next;
};
CauseText cause_text(const std::string& kind);

}  // namespace host
