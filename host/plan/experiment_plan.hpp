// Plans the run that best tells the remaining explanations of a machine's records apart.
#pragma once

#include <string>
#include <vector>

#include "host/plan/decision.hpp"
#include "host/plan/run_plan.hpp"

namespace host {

struct PlanOptions {
  /// Number of integrator steps after which no further piece is tried. It is not a time limit, so that every machine
  /// makes the same plan.
  double most_steps = 600e6;
  std::uint64_t seed = 1;  ///< seed of the noise in simulated runs
};

/// Expected result of the run for two of the rivals.
struct PairOutlook {
  std::size_t a = 0, b = 0;  ///< indices of rivals
  bool separable = false;
  /// Expected odds of the true rival to the other after the run, from even odds, up to kHighestOdds.
  double odds_if_a = 1.0, odds_if_b = 1.0;
  std::string by_hand = {};  ///< manual test, if no motion in the box separates the two
};

/// A simulated piece and its effect alone.
struct ConsideredPiece {
  RunPiece piece;
  double expected_log_odds = 0.0;  ///< of the pair that it separates least, among the separable pairs
};

/// The run with one rival true and all rivals refitted to it.
struct PredictedRun {
  Record record;
  std::vector<sim::DriveDescription> bent;  ///< one refitted model per rival
};

struct Plan {
  std::vector<Rival> rivals;
  std::vector<PairOutlook> pairs;
  bool separable = false;  ///< true if at least one pair is separable
  std::string by_hand;     ///< manual tests for the other pairs, in words; empty if all are separable
  RunPlan run;             ///< without pieces if nothing is separable
  /// Odds of the true rival to the most similar one that the run separates from it: geometric mean over all rivals as
  /// the true one.
  double expected_odds = 1.0;
  std::vector<ConsideredPiece> considered;  ///< best first
  std::vector<PredictedRun> predicted;      ///< with each rival true in turn
  double steps = 0.0;                       ///< integrator steps used
  bool cut_short = false;                   ///< some pieces were not tried
};

/// A manual test for two explanations that no motion can tell apart.
std::string separation_by_hand(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// `model`: the board uses the design for this model. `rivals`: from fit_rivals() on the same training records, or the
/// remaining ones of a Decision; at least two. In each simulated run one of them is true, and the others are refitted
/// as far as the training records allow. Throws Failure(usage) for fewer than two rivals, and what design and records
/// throw.
Plan plan_run(const sim::DriveDescription& model, const std::vector<const Record*>& training,
              const std::vector<Rival>& rivals, const ExcitationLimits& box, const PlanOptions& options = {},
              const ShareDone& progress = {});

}  // namespace host
