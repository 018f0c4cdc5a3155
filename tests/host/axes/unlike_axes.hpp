// Two drives that differ by a factor of two in inertia, friction and possible bandwidth, and the measures of their
// lines and circles.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "host/axes/machine_design.hpp"
#include "host/identify/paper_drives.hpp"

namespace axes_test {

inline constexpr double kCount_um = 1e4 / 4096.0;

inline sim::EffectEntry effect(const char* kind, std::map<std::string, double> parameters) {
  return {.kind = kind, .parameters = std::move(parameters), .ci95 = {}, .from = {}};
}

/// The paper's x axis with inertia and friction multiplied by `times` and an amplifier delay of `delay_s`.
inline sim::DriveDescription drive(const char* name, double times, double delay_s) {
  sim::DriveDescription made = *host::paper_drive("x");
  made.name = name;
  for (sim::EffectEntry& entry : made.effects)
    for (auto& [id, value] : entry.parameters)
      if (!id.starts_with("omega")) value *= times;
  made.effects.push_back(effect("input_delay", {{"delay", delay_s}}));
  return made;
}

using Tasks = std::vector<host::AxisTask>;

inline const Tasks& machine() {
  static const Tasks tasks{{drive("x", 1.0, 3e-4), {}}, {drive("y", 2.0, 8e-4), {}}};
  return tasks;
}

inline host::MachineDesign designed(const Tasks& tasks, bool zero_phase) {
  host::DesignOptions options;
  options.zero_phase = zero_phase;
  options.tach_variance = 0.05;
  options.position_variance = std::pow(kCount_um / 1e3, 2) / 12.0;
  host::LoopAim aim;
  aim.modulus = 0.4;
  return host::design_machine(tasks, options, aim);
}

/// Difference of the half axes of the ellipse about the centre (0, 0), fitted to these points (mm).
class EllipseFit {
 public:
  explicit EllipseFit(double radius_mm) : radius_mm_(radius_mm) {}

  void add(double x, double y) {
    const double at = std::atan2(y, x);
    Eigen::Matrix<double, 5, 1> row;
    row << 1.0, std::cos(at), std::sin(at), std::cos(2.0 * at), std::sin(2.0 * at);
    gram_ += row * row.transpose();
    pull_ += row * 1e3 * (std::hypot(x, y) - radius_mm_);
  }

  double um() const {
    const Eigen::Matrix<double, 5, 1> found = gram_.ldlt().solve(pull_);
    return 2.0 * std::hypot(found(3), found(4));
  }

 private:
  double radius_mm_;
  Eigen::Matrix<double, 5, 5> gram_ = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> pull_ = Eigen::Matrix<double, 5, 1>::Zero();
};

}  // namespace axes_test
