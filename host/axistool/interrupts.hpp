// Ctrl-C while something moves: it asks for an orderly end instead of leaving the axis to the board's time-out.
#pragma once

namespace axistool {

/// From now on Ctrl-C, SIGTERM and SIGHUP are for interrupted() to tell.
void catch_interrupts();

/// They end the program again, at once.
void release_interrupts();

bool interrupted();

}  // namespace axistool
