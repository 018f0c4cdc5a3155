// Stick-slip in a pass: where an axis rests on its encoder, while the circle goes on, and jumps after it.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace host {

struct CirclePass;

/// Noise of equally spaced values, from their second differences (factor 1 + 4 + 1 = 6). 1 for fewer than three values.
double noise_of(const Eigen::VectorXd& values);

/// An axis that rests is off the circle by `ahead - breakaway lag * level` along its own direction: when it breaks
/// away, the circle is ahead of it by the lag at which its loop overcomes static friction. With velocity feedback this
/// lag falls with the speed. From one rest to the next it moves as measured, and for the median duration of these jumps
/// it comes from and goes to the circle. One value each sample; empty without rests.
struct AxisRests {
  bool jumps = false;            ///< whether there are two rests one after the other: a single one may be a reversal
  std::vector<double> ahead_um;  ///< the circle at the end of the rest less the circle now, along the axis
  std::vector<double> level;     ///< -1 or 1: direction of the circle at the end of the rest; 0 without rests
  std::vector<double> level_by_speed;  ///< the circle's speed along the axis at the end of the rest, mm/s
};
AxisRests rests_of(const CirclePass& pass, char axis);

/// Commanded speed of an axis, mm/s, below which two rests in succession show in this pass. Stick-slip that has ended
/// at this speed shows as one rest at the reversal, which is a reversal spike.
double stick_slip_speed(const CirclePass& pass);

}  // namespace host
