// A planned run on a simulated machine, with the board's own controller.
#pragma once

#include <cstdint>
#include <string>

#include "host/plan/excited_axis.hpp"
#include "host/plan/run_plan.hpp"

namespace host {

/// Result of a run.
struct RunOutcome {
  Record record;
  bool completed = false;  ///< true if every piece ended within its box
  std::string ended;       ///< end of the last piece, in words
  double farthest = 0.0;   ///< largest distance from the start of the run, mm (m)
};

/// The parameters that `axistool design` makes for this model, on the board's first axis. Throws Failure(bad_input) for
/// a model for which no design is possible.
firmware::ParameterValues design_values(const sim::DriveDescription& model);

/// The units of a drive with such a design.
ExcitationScale scale_of_drive(const sim::DataSheet& data);

/// Runs the pieces one after the other. Ends with the first piece that does not complete.
template <firmware::SupervisedHal Hal>
RunOutcome run_on(ExcitedAxis<Hal>& axis, const RunPlan& run, const ExcitationScale& scale) {
  RunOutcome outcome;
  outcome.completed = !run.pieces.empty();
  for (const RunPiece& piece : run.pieces) {
    const double offset = axis.offset();
    const firmware::ExcitationStatePayload state = axis.run(design_piece(piece, run.box, offset, scale));
    outcome.farthest = std::max(outcome.farthest, std::abs(offset) + state.farthest * scale.encoder_resolution);
    outcome.ended = end_name(state);
    if (state.end != static_cast<std::uint8_t>(firmware::ExcitationEnd::completed)) {
      outcome.completed = false;
      break;
    }
  }
  outcome.record = axis.take();
  outcome.record.header = run_header(run);
  return outcome;
}

/// Simulates the run on a plant made of `machine`. `board`: from design_values(). `seed`: of the tachometer noise.
/// Throws Failure if a piece does not fit its box.
RunOutcome simulate_run(const RunPlan& run, const sim::DriveDescription& machine,
                        const firmware::ParameterValues& board, std::uint64_t seed);

}  // namespace host
