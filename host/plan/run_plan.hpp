// A planned run: successive pieces of excitation in one record, within one box.
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
  std::string closed_loop;  ///< "", "reference" or "output"; ladder, dwell and reversals are always closed-loop
  double time_s = 1.0;      ///< > 0
  unsigned seed = 1;
};

struct RunPlan {
  std::vector<RunPiece> pieces;
  ExcitationLimits box;             ///< of the whole run, relative to the first position of the axis
  std::vector<std::string> rivals;  ///< explanations to separate, "cogging", "backlash + input_delay"
  double expected_odds = 0.0;       ///< expected odds of the true rival to the next one; 0 if unknown

  double duration_s() const;
};

/// "steps 3 -3 hold=0.3, open loop, 2 s"
std::string piece_text(const RunPiece& piece);

/// The excitation of a piece that begins at `offset` from the start of the run, mm (m). Its window is the rest of the
/// box on both sides. Throws Failure as design_excitation() does.
Excitation design_piece(const RunPiece& piece, const ExcitationLimits& box, double offset,
                        const ExcitationScale& scale);

/// The intersection of two boxes.
ExcitationLimits within_both(const ExcitationLimits& a, const ExcitationLimits& b);

/// Header fields for the record of the run, in addition to those of its pieces.
std::map<std::string, std::string> run_header(const RunPlan& run);

/// `axis-run-plan/1` in TOML. Reading throws Failure(bad_input) with file, line and field.
std::string run_plan_toml(const RunPlan& run);
RunPlan parse_run_plan(std::string_view text, const std::string& name);
RunPlan read_run_plan(const std::string& path);
void write_run_plan(const RunPlan& run, const std::string& path);

}  // namespace host
