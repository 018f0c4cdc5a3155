// Plans the run that best separates the remaining explanations of a machine's records.
#pragma once

#include <string>
#include <vector>

#include "host/plan/decision.hpp"
#include "host/plan/run_plan.hpp"

namespace host {

struct PlanOptions {
  /// Limit of integrator steps, after which no further piece is tried. Not a time limit, so that every machine plans
  /// the same.
  double most_steps = 600e6;
  std::uint64_t seed = 1;  ///< of the noise in simulated runs
};

/// Outlook of the run for two of the rivals.
struct PairOutlook {
  std::size_t a = 0, b = 0;  ///< indices of rivals
  bool separable = false;
  /// Expected odds of the true one to the other after the run, from even odds, up to kHighestOdds.
  double odds_if_a = 1.0, odds_if_b = 1.0;
  std::string by_hand = {};  ///< test that separates them if no motion in the box does
};

/// A piece that was simulated, and its effect alone.
struct ConsideredPiece {
  RunPiece piece;
  double expected_log_odds = 0.0;  ///< of the pair that it separates least, among those that any piece separates
};

/// The run with one rival true, and all rivals re-fitted to it.
struct PredictedRun {
  Record record;
  std::vector<sim::DriveDescription> bent;  ///< as many as there are rivals
};

struct Plan {
  std::vector<Rival> rivals;
  std::vector<PairOutlook> pairs;
  bool separable = false;  ///< some pair is
  std::string by_hand;     ///< tests for the pairs that are not, in words; empty if all are
  RunPlan run;             ///< without pieces if nothing is separable
  /// Odds of the true rival to the most similar one that the run separates from it: geometric mean over the possible
  /// truths.
  double expected_odds = 1.0;
  std::vector<ConsideredPiece> considered;  ///< best first
  std::vector<PredictedRun> predicted;      ///< with each rival true in turn
  double steps = 0.0;                       ///< of the integrator
  bool cut_short = false;                   ///< some pieces were not tried
};

/// A manual test for two explanations that no motion separates.
std::string separation_by_hand(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// `model`: its design runs on the board. `rivals`: of fit_rivals() on the same training records, or the remaining ones
/// of a Decision; at least two. In each simulated run one of them is true, and the others are re-fitted as far as the
/// training records allow. Throws Failure(usage) for fewer than two rivals, and what design and records throw.
Plan plan_run(const sim::DriveDescription& model, const std::vector<const Record*>& training,
              const std::vector<Rival>& rivals, const ExcitationLimits& box, const PlanOptions& options = {},
              const ShareDone& progress = {});

}  // namespace host
