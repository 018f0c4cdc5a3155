// Decides between rivals by a run: odds from exp(-chi^2/2) with each rival's parameters re-fitted, and chi^2 divided by
// the dispersion of the best of them (quasi-likelihood; McCullagh and Nelder, Generalized Linear Models, ch. 9).
#pragma once

#include <string>
#include <vector>

#include "host/plan/rival.hpp"

namespace host {

/// No odds are stated above these: what no rival holds, and no model of the noise, is never less probable.
inline constexpr double kHighestOdds = 1000.0;
/// A run has decided where the best rival is as probable as this.
inline constexpr double kDecided = 0.95;

/// Range of stated odds: 1 to kHighestOdds, within rounding.
double stated_odds(double odds);

/// "more than 1000 to 1", "38 to 1"
std::string odds_text(double odds);

struct Decision {
  std::vector<Rival> rivals;       ///< with their parameters fitted to everything, and their probabilities afterwards
  std::vector<double> chi_square;  ///< chi^2 that the run adds to each rival's, re-fitted to both, over the dispersion
  /// Squared error over squared floor that even the best rival leaves of training and run together, at least 1: where
  /// no rival is the whole truth, what they make of its rest speaks as much less.
  double dispersion = 1.0;
  std::size_t best = 0;           ///< index of the most probable
  double odds = 1.0;              ///< of the best to the next, at most kHighestOdds
  std::vector<std::size_t> left;  ///< rivals that are not yet ruled out: the best, and all with odds below 19:1 to it
  double error = 0.0;  ///< of the best rival on the run, over the floor, as a fit weighs it; about 1 for a true one
  /// False where the run leaves even the best rival far above what it leaves of the training records: it shows
  /// something that none of them holds, and decides nothing. The probabilities are then those of before, and all are
  /// left.
  bool explains = true;
};

/// `rivals`: fitted to the training records, with what is believed before the run. What they cost on the training
/// records is part of that belief; a rival that bends to suit the run pays there for it.
Decision decide(const std::vector<Rival>& rivals, const std::vector<const Record*>& training, const Record& run);

/// The same for records that are prepared. `ground`: training records on common ground.
Decision decide_on(const std::vector<Rival>& rivals, const RecordSet& ground, const RecordSet& run);

}  // namespace host
