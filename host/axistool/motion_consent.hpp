// Warning and waiting time before a command moves an axis by itself.
#pragma once

#include <string>

#include "host/device/excitation.hpp"

namespace axistool {

std::string box_text(const host::ExcitationLimits& box, sim::DriveKind kind);

/// Prints on standard error. Throws Failure(refused) if it is interrupted.
void count_down(int seconds);

}  // namespace axistool
