// Before and while a command moves an axis by itself: what it says, the seconds to step back, and Ctrl-C.
#pragma once

#include <string>

#include "host/device/excitation.hpp"

namespace axistool {

std::string box_text(const host::ExcitationLimits& box, sim::DriveKind kind);

/// From now on Ctrl-C and SIGTERM are for interrupted() to tell.
void catch_interrupts();
bool interrupted();

/// On standard error. Throws Failure(refused) where it is interrupted.
void count_down(int seconds);

}  // namespace axistool
