// Checks that an axis moved enough for an identification.
#pragma once

#include <string>
#include <vector>

#include "host/identify/rigid_estimate.hpp"
#include "host/record/record.hpp"

namespace host {

/// Condition number of a regression above which even a relative signal error of 2 % may appear fully in the result.
inline constexpr double kPoorCondition = 50.0;

/// Motion of the axis in the records. Speeds in rad/s or m/s.
struct ExcitationSummary {
  double forward_s = 0.0;  ///< time of sliding above the threshold
  double backward_s = 0.0;
  double threshold = 0.0;  ///< least speed that counts as sliding
  double top_speed = 0.0;
  double peak_effort = 0.0;     ///< torque or force of the motor: 99 % quantile, Nm or N
  double peak_command_V = 0.0;  ///< largest |u|; 0 if only a current was logged
  double peak_current_A = 0.0;  ///< largest |i|; 0 if no current was logged
};

ExcitationSummary summarise_excitation(const std::vector<Record>& records, const std::vector<Motion>& motions,
                                       const sim::DataSheet& data);

/// Throws Failure(refused), with the excitation to use, if the axis slid for less than 0.1 s in either direction.
void require_motion(const ExcitationSummary& summary, const sim::DataSheet& data);

/// Throws Failure(refused) if the estimate does not determine the inertia (its interval contains zero, or it is NaN).
void require_determined(const RigidEstimate& estimate, const ExcitationSummary& summary, const sim::DataSheet& data);

/// Warnings about a doubtful estimate: dominant static friction (as at the paper's Ku = 5), nearly dependent
/// regressors, a wide interval, negative friction.
std::vector<std::string> judge_estimate(const RigidEstimate& estimate, const ExcitationSummary& summary,
                                        const sim::DataSheet& data);

}  // namespace host
