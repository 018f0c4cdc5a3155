// The motion of a record: travel and speed smoothed from encoder and command, with their uncertainty.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// One element per sample. Travel in mm or m, speed in rad/s or m/s.
struct SmoothedMotion {
  std::vector<double> x;
  std::vector<double> w;
  std::vector<double> disturbance;  ///< torque or force beyond that of the linear drive, Nm or N (includes friction)
  std::vector<double> x_variance;   ///< variances of the errors of x and w, and their covariance
  std::vector<double> w_variance;
  std::vector<double> xw_covariance;
  std::vector<bool> standing;  ///< the encoder shows no motion
  double hidden_creep = 0.0;   ///< largest speed that the encoder cannot show, rad/s or m/s
};

/// Amplifier gain that converts a logged current to a command, A/V. Throws Failure(bad_input) if the record has no
/// current or the data sheet has no gain.
double current_per_volt(const Record& record, const sim::DataSheet& data);

/// Commands in volts at the amplifier's input, each the mean from its row to the next: u_V, or the logged current
/// divided by the amplifier's gain. Throws Failure(bad_input) if neither is available.
std::vector<double> command_volts(const Record& record, const sim::DataSheet& data);

/// Sensitivity of one row's smoothed state to encoder readings and commands around it. The smoother is linear, so each
/// row has one weight and the contributions add up.
struct ShiftWeights {
  std::size_t first = 0;                           ///< row of the first weight
  std::vector<double> x_of_reading, w_of_reading;  ///< per mm (m) of change of a row's reading
  std::vector<double> x_of_command, w_of_command;  ///< per volt of change of a row's command

  struct Shift {
    double x, w;
  };
  /// Shift of the smoothed state by changes of the rows from `first` on; either may be empty.
  Shift shift(std::span<const double> reading, std::span<const double> command_V) const;
};

/// Rauch-Tung-Striebel smoother of the model (15): travel, speed and a random-walk disturbance, driven by the command.
/// It is corrected only by the encoder, so that tachometer errors do not enter. A record without a position is smoothed
/// from its speed. The gains depend on the record; further signals pass through the same filter.
class MotionSmoother {
 public:
  /// `inertia` and `viscous` must be correct within some 30 %; the disturbance absorbs the rest. `friction_level`:
  /// approximate jump of the friction at a start, stop or reversal, Nm or N.
  MotionSmoother(const Record& record, const sim::DataSheet& data, double inertia, double viscous,
                 double friction_level);
  /// Takes the inertia and the friction of a model. Throws Failure(bad_input) if the model has no inertia.
  MotionSmoother(const Record& record, const sim::DriveDescription& model);

  const SmoothedMotion& motion() const { return motion_; }

  /// Number of rows before and after a row that affect its smoothed state (some ten times the smoother's memory).
  std::size_t reach() const { return reach_; }

  /// Sensitivity of one row's smoothed state to changes around it, within reach() on both sides.
  ShiftWeights shift_weights(std::size_t row) const;

 private:
  struct Observation;
  /// Gains of one sample: of its measurement, of a known standstill, and of the backward pass.
  struct Gains {
    Eigen::Vector3d measurement;
    Eigen::Vector3d standstill;
    Eigen::Matrix3d backward;
    bool standing;
  };
  void solve_gains(const std::vector<Observation>& observed, double creep_variance,
                   const Eigen::Vector3d& start_variance);
  void smooth(const std::vector<Observation>& observed, const std::vector<double>& u_V, const Eigen::Vector3d& start);

  bool by_position_;
  std::size_t reach_;
  double effort_per_volt_;
  Eigen::Matrix3d A_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d B_ = Eigen::Vector3d::Zero();
  std::vector<Gains> gains_;
  SmoothedMotion motion_;
};

}  // namespace host
