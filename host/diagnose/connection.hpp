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
inline constexpr std::array<std::string_view, 2> kConnections = {"compliance", "backlash"};
bool is_connection(std::string_view kind);

/// Compares the gap or spring that the force balance names with the other one by the motion, both fitted to the
/// training records. The balance holds sliding motion only and sees a load that lags; a reversal shows whether by a gap
/// or by a spring. The other one takes the place of the named one if it predicts both sets better. Nothing changes
/// where the other one is in `absent`, where both are a group already, or where the balance names neither.
void compare_connections_by_motion(Diagnosis& diagnosis, const std::vector<std::string>& absent);

/// Withdraws a gap or spring that the force balance names if it increases the error of the prediction from the command
/// on held-back records, because nothing between motor and table was measured. The verdict says so.
void take_back_denied_connection(Diagnosis& diagnosis);

}  // namespace host
