// A gap or a spring between motor and table that the force balance names, where only the motor was measured: the motion
// has the last word.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "host/diagnose/diagnosis.hpp"

namespace host {

/// What may lie between motor and table.
inline constexpr std::string_view kSpring = "compliance", kGap = "backlash";
inline constexpr std::array kConnections = {kSpring, kGap};
bool is_connection(std::string_view kind);

/// Compares a spring that the force balance names with a gap by the motion. The balance holds sliding motion only and
/// sees a load that lags; a reversal shows whether by a gap. Both are fitted alone and beside the other effects that
/// the balance names. The gap takes the spring's place if it predicts both sets better; the other effects, which were
/// named beside the wrong connection, stay if they improve the prediction. Not the other way round: a gap contains the
/// spring behind it, so a spring that predicts better shows only that the fit of the gap has not ended. Nothing changes
/// where a gap is in `absent` or in a group.
void compare_spring_with_gap_by_motion(Diagnosis& diagnosis, const sim::DriveDescription& given,
                                       const Measurements& measured, const std::vector<std::string>& absent);

/// Withdraws a gap or spring that the force balance names if it increases the error of the prediction from the command
/// on held-back records, because nothing between motor and table was measured. The verdict says so.
void take_back_denied_connection(Diagnosis& diagnosis);

}  // namespace host
