// Reaction to a processor fault: makes the outputs safe, writes the record, resets.
#pragma once

namespace firmware::boards {

/// Every board provides this: D/A to 0 V and enables off, with register writes alone. It must work from any state of
/// the program, so it may rely on no variable, only on pins that start-up has configured.
void make_outputs_safe() noexcept;

/// Completes the fault part of the survival record, so that the next run accepts it.
void seal_fault();

/// Makes faults precise: separate handlers, division by zero traps, and an MPU region without access under the stack.
void arm_fault_detection();

/// Ends the run at once; the record tells the next run that software requested it.
[[noreturn]] void reset_processor();

}  // namespace firmware::boards
