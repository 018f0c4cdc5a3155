// Ctrl-C during a motion requests an orderly stop instead of leaving the axis to the board's time-out.
#pragma once

namespace axistool {

/// From now on interrupted() reports Ctrl-C, SIGTERM and SIGHUP.
void catch_interrupts();

/// From now on these signals end the program at once again.
void release_interrupts();

bool interrupted();

}  // namespace axistool
