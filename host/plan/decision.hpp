// Decides between rivals by a run. Odds are exp(-chi^2/2) with the parameters of each rival fitted again, and chi^2
// divided by the dispersion of the best rival (quasi-likelihood; McCullagh and Nelder, Generalized Linear Models, ch.
// 9).
#pragma once

#include <string>
#include <vector>

#include "host/plan/rival.hpp"

namespace host {

/// Larger odds are not stated, because an effect outside all rivals or a wrong noise model is always possible.
inline constexpr double kHighestOdds = 1000.0;
/// Probability of the best rival from which a run has decided.
inline constexpr double kDecided = 0.95;

/// Limits odds to 1 ... kHighestOdds, within rounding.
double stated_odds(double odds);

/// "more than 1000 to 1", "38 to 1"
std::string odds_text(double odds);

struct Decision {
  std::vector<Rival> rivals;       ///< fitted to all records, with their posterior probabilities
  std::vector<double> chi_square;  ///< increase of each rival's chi^2 by the run, refitted to both, over the dispersion
  /// Dispersion: squared error over squared noise floor of the best rival on training and run together, at least 1. If
  /// no rival is the whole truth, their differences count less by this factor.
  double dispersion = 1.0;
  std::size_t best = 0;           ///< index of the most probable rival
  double odds = 1.0;              ///< odds of the best to the next rival, at most kHighestOdds
  std::vector<std::size_t> left;  ///< remaining rivals: the best, and all against which its odds are below 19:1
  double error = 0.0;  ///< of the best rival on the run, over noise floor, weighted as in a fit; about 1 if true
  /// False if even the best rival has an error on the run far above that on the training records. Then the run shows an
  /// effect outside all rivals and decides nothing: the probabilities are the prior ones, and all rivals remain.
  bool explains = true;
};

/// `rivals`: fitted to the training records, with their prior probabilities. These already include the error on the
/// training records. If the fit to the run increases that error, it counts against the rival.
Decision decide(const std::vector<Rival>& rivals, const std::vector<const Record*>& training, const Record& run);

/// The same for prepared records. `ground`: training records with common noise floors.
Decision decide_on(const std::vector<Rival>& rivals, const RecordSet& ground, const RecordSet& run);

}  // namespace host
