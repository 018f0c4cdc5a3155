// A planned run: pieces of excitation, one after the other in one record, within one box.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/device/excitation.hpp"

namespace host {

/// One piece: a kind of `axistool excite` with its numbers.
struct RunPiece {
  std::string kind;
  ExcitationNumbers numbers;
  std::string closed_loop;  ///< "", "reference" or "output"; ladder, dwell and reversals always run in closed loop
  double time_s = 1.0;      ///< > 0
  unsigned seed = 1;
};

struct RunPlan {
  std::vector<RunPiece> pieces;
  ExcitationLimits box;             ///< of the whole run, around the axis's first position
  std::vector<std::string> rivals;  ///< explanations to separate, "cogging", "backlash + input_delay"
  double expected_odds = 0.0;       ///< prior expectation of the odds of the true rival to the next; 0: none

  double duration_s() const;
};

/// "steps 3 -3 hold=0.3, open loop, 2 s"
std::string piece_text(const RunPiece& piece);

/// The excitation of a piece that begins at this distance from the run's start, mm (m): its window is the rest of the
/// box on both sides. Throws Failure as design_excitation() does.
Excitation design_piece(const RunPiece& piece, const ExcitationLimits& box, double offset,
                        const ExcitationScale& scale);

/// The intersection of two boxes.
ExcitationLimits within_both(const ExcitationLimits& a, const ExcitationLimits& b);

/// Header fields of the run's record, in addition to those of its pieces.
std::map<std::string, std::string> run_header(const RunPlan& run);

/// `axis-run-plan/1`, TOML. Reading throws Failure(bad_input) naming file, line and field.
std::string run_plan_toml(const RunPlan& run);
RunPlan parse_run_plan(std::string_view text, const std::string& name);
RunPlan read_run_plan(const std::string& path);
void write_run_plan(const RunPlan& run, const std::string& path);

}  // namespace host
