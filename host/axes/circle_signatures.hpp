// Signature of each cause in the radial deviation: columns of one linear model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/axes/circle_pass.hpp"

namespace host {

/// Rows of one pass by one sensor.
struct CircleBlock {
  std::size_t pass;
  bool is_outer;
  Eigen::Index first, end;
  double weight;  ///< 1 / noise, 1/um, so that weighted rows of every sensor have noise 1
};

/// All rows of all passes and sensors, each the mean of some samples.
class CircleRows {
 public:
  explicit CircleRows(const std::vector<CirclePass>& passes);

  /// Radial deviation at a sample of a pass, um.
  using Signature = std::function<double(const CirclePass& pass, std::size_t sample)>;
  /// The signature in all rows, times their weights; 0 in rows of the encoders if `outer_only`.
  Eigen::VectorXd column(const Signature& signature, bool outer_only) const;
  /// The same for each block separately.
  Eigen::VectorXd block_column(const Signature& signature, const CircleBlock& block) const;

  const Eigen::VectorXd& deviation() const { return deviation_; }
  const std::vector<CirclePass>& passes() const { return passes_; }
  const std::vector<CircleBlock>& blocks() const { return blocks_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Angle at the middle of each row.
  const Eigen::VectorXd& angle_rad() const { return angle_; }
  const Eigen::VectorXd& time_s() const { return time_; }
  bool has_outer() const { return has_outer_; }
  /// Duration of a row, of a pass and of the fastest pass.
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

/// One cause with given values of its nonlinear parameters.
struct CircleCause {
  std::string kind, axis;  ///< axis: "x", "y", "xy"
  std::vector<CircleRows::Signature> signatures;
  bool outer_only = false;     ///< only an outer sensor shows it
  Eigen::MatrixXd columns;     ///< the signatures as rows
  Eigen::VectorXd deviations;  ///< prior standard deviation of the factors, um
  double log_prior = 0.0;
  std::optional<double> period_mm, frequency_Hz;
  /// Value of a factor of 1 um in the cause's own unit: ms, um/m, ppm; empty if that unit is um.
  double amount_per_um = 1.0;
  std::string amount_unit = "um";
};

/// Largest number of cycles of a wave per row of the fastest pass at which the rows show it.
inline constexpr double kMostCyclesARow = 0.4;
/// Whether rows, which are means, show the wave, possibly as an alias, which its signature includes.
bool shows_through(double frequency_Hz, double row_s);

enum class WaveKind { cyclic_error, torque_ripple, vibration };

/// Causes that these sensors show: those without a nonlinear parameter, and reversal spikes with several decay times.
std::vector<CircleCause> plain_causes(const CircleRows& rows);

/// Lost motion between an axis's motor and the table: the table rests until the motor, as its encoder shows it, has
/// crossed the gap, > 0.
CircleCause backlash_cause(const CircleRows& rows, char axis, double gap_um);

/// A wave over the travel of an axis (value: its period, mm) or over time (frequency, Hz).
CircleCause wave_cause(const CircleRows& rows, WaveKind kind, char axis, double value);

/// Torque ripple near the loop's natural frequency, where a series in the frequency does not describe the loop.
CircleCause ripple_through_any_loop(const CircleRows& rows, char axis, double period_mm);

/// The wave of this kind over this axis that fits the residual best, on a grid of periods or frequencies. `left`: the
/// weighted rows of the residual.
CircleCause best_wave(const CircleRows& rows, const Eigen::VectorXd& left, WaveKind kind, char axis);
/// The same near a given wave.
CircleCause nearby_wave(const CircleRows& rows, const Eigen::VectorXd& left, const CircleCause& wave);

/// Kinds that these sensors and passes do not show or separate, with the reason and the remedy.
struct Unseen {
  std::string kind, why;
};
std::vector<Unseen> unseen_causes(const CircleRows& rows);

/// Meaning and remedy.
struct CauseText {
  const char *title, *next;
};
CauseText cause_text(const std::string& kind);

}  // namespace host
