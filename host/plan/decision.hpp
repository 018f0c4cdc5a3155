// Decides between rivals by a run: odds from exp(-chi^2/2) with each rival's parameters re-fitted, and chi^2 divided by
// the dispersion of the best of them (quasi-likelihood; McCullagh and Nelder, Generalized Linear Models, ch. 9).
#pragma once

#include <string>
#include <vector>

#include "host/plan/rival.hpp"

namespace host {

/// Larger odds are not stated: an effect that no rival holds, or a wrong noise model, is never less probable.
inline constexpr double kHighestOdds = 1000.0;
/// Probability of the best rival at which a run has decided.
inline constexpr double kDecided = 0.95;

/// Range of stated odds: 1 to kHighestOdds, within rounding.
double stated_odds(double odds);

/// "more than 1000 to 1", "38 to 1"
std::string odds_text(double odds);

struct Decision {
  std::vector<Rival> rivals;       ///< with their parameters fitted to all records, and their posterior probabilities
  std::vector<double> chi_square;  ///< chi^2 that the run adds to each rival's, re-fitted to both, over the dispersion
  /// Dispersion: squared error over squared floor of the best rival on training and run together, at least 1. If no
  /// rival is the whole truth, their differences count less by this factor.
  double dispersion = 1.0;
  std::size_t best = 0;           ///< index of the most probable
  double odds = 1.0;              ///< of the best to the next, at most kHighestOdds
  std::vector<std::size_t> left;  ///< rivals that are not ruled out: the best, and all with odds below 19:1 to it
  double error = 0.0;  ///< of the best rival on the run, over the floor, as a fit weighs it; about 1 for a true one
  /// False if the run's error of even the best rival is far above that of the training records: then it shows an effect
  /// that no rival holds, and decides nothing. The probabilities are then the prior ones, and all rivals remain.
  bool explains = true;
};

/// `rivals`: fitted to the training records, with their prior probabilities. These include their error on the training
/// records; a rival that is re-fitted to the run pays for it there.
Decision decide(const std::vector<Rival>& rivals, const std::vector<const Record*>& training, const Record& run);

/// The same for prepared records. `ground`: training records with common noise floors.
Decision decide_on(const std::vector<Rival>& rivals, const RecordSet& ground, const RecordSet& run);

}  // namespace host
