// Checks that an axis moved enough for an identification.
#pragma once

#include <string>
#include <vector>

#include "host/identify/rigid_estimate.hpp"
#include "host/record/record.hpp"

namespace host {

/// Condition number of a regression beyond which a relative error of 2 % in the signals may pass unattenuated.
inline constexpr double kPoorCondition = 50.0;

/// Motion of the axis in the records. Speeds in rad/s or m/s.
struct ExcitationSummary {
  double forward_s = 0.0;  ///< time spent sliding beyond the threshold
  double backward_s = 0.0;
  double threshold = 0.0;  ///< speed that counts as sliding
  double top_speed = 0.0;
  double peak_effort = 0.0;     ///< of the motor: 99 % of the samples lie below, Nm or N
  double peak_command_V = 0.0;  ///< largest |u|; 0 where only a current was logged
  double peak_current_A = 0.0;  ///< largest |i|; 0 without a current
};

ExcitationSummary summarise_excitation(const std::vector<Record>& records, const std::vector<Motion>& motions,
                                       const sim::DataSheet& data);

/// Throws Failure(refused) with the excitation to use when the axis slid for less than 0.1 s in either direction.
void require_motion(const ExcitationSummary& summary, const sim::DataSheet& data);

/// Throws Failure(refused) when the estimate does not determine the inertia (interval reaches zero, or not a number).
void require_determined(const RigidEstimate& estimate, const ExcitationSummary& summary, const sim::DataSheet& data);

/// Warnings about a doubtful estimate: static friction dominates (as at the paper's Ku = 5), regressors nearly
/// dependent, wide interval, negative friction.
std::vector<std::string> judge_estimate(const RigidEstimate& estimate, const ExcitationSummary& summary,
                                        const sim::DataSheet& data);

}  // namespace host
