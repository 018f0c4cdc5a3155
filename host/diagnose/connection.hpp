// A gap or a spring between motor and table that the force balance names, where only the motor was measured: the motion
// has the last word.
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "host/diagnose/diagnosis.hpp"
#include "host/effort/effort_screen.hpp"

namespace host {

/// What may lie between motor and table.
inline constexpr std::array<std::string_view, 2> kConnections = {"compliance", "backlash"};
bool is_connection(std::string_view kind);

/// The screen with the connection that the motion shows in place of the one that the force balance names: the other
/// one, if with it and the effects named before it both sets are predicted better; nothing that was named after it
/// remains. The balance holds sliding motion only and sees a load that lags; a reversal shows whether by a gap or by a
/// spring. Empty where the screen stands: it names neither, both as a group, or the other one is in sets.absent.
std::shared_ptr<const EffortScreen> with_connection_of_motion(const EffortScreen& screen, const PreparedSets& sets);

/// Withdraws a gap or spring that the force balance names if it increases the error of the prediction from the command
/// on held-back records, because nothing between motor and table was measured. The verdict says so.
void take_back_denied_connection(Diagnosis& diagnosis);

}  // namespace host
