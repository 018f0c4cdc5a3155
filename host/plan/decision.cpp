#include "host/plan/decision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "host/fit/prepared_sets.hpp"
#include "host/parallel.hpp"
#include "host/plan/information.hpp"

namespace host {

namespace {

/// Another motion may double the error of a good model. A larger error means another effect.
constexpr double kFar = 2.0;

/// chi^2 per observation of the best rival, at least 1.
double dispersion_of(const std::vector<Rival>& rivals, const RecordSet& both) {
  double least = HUGE_VAL;
  for (const Rival& rival : rivals) least = std::min(least, chi_square_each(rival.model, both));
  return std::max(1.0, least);
}

/// chi^2 of the table in addition to that of the motor, for each rival refitted to both. Errors of the scale, which all
/// rivals lack, count as dispersion.
void add_table(Decision& decision, const RecordSet& both, const RecordSet& before) {
  const std::size_t rivals = decision.rivals.size();
  std::vector<Information> table(rivals), motor(rivals);
  std::vector<double> known(rivals, 0.0);
  double dispersion = HUGE_VAL;
  for_each_in_parallel(rivals, [&](std::size_t k) {
    const sim::DriveDescription& model = decision.rivals[k].model;
    table[k] = information_of_table(model, both);
    motor[k] = information_of_motion(model, both);
    known[k] = information_of_table(model, before).least();
  });
  for (const Information& one : table)
    dispersion = std::min(dispersion, one.least() / static_cast<double>(table_windows(both)));
  dispersion = std::max(1.0, dispersion);
  for (std::size_t k = 0; k < rivals; ++k) {
    if (table[k].slope.size() == 0 || motor[k].slope.size() == 0) continue;
    Information sum = motor[k];
    sum *= 1.0 / decision.dispersion;
    const double alone = sum.least();
    table[k] *= 1.0 / dispersion;
    sum += table[k];
    decision.chi_square[k] += std::max(0.0, sum.least() - alone) - known[k] / dispersion;
  }
}

}  // namespace

double stated_odds(double odds) {
  constexpr double kRounding = 1e-6;
  return odds > kHighestOdds * (1.0 - kRounding) ? kHighestOdds : std::max(1.0, odds);
}

std::string odds_text(double odds) {
  return odds >= kHighestOdds ? fmt::format("more than {:g} to 1", kHighestOdds) : fmt::format("{:.2g} to 1", odds);
}

Decision decide(const std::vector<Rival>& rivals, const std::vector<const Record*>& training, const Record& run) {
  return decide_on(rivals, common_ground(training, rivals), common_ground({&run}, rivals));
}

Decision decide_on(const std::vector<Rival>& rivals, const RecordSet& ground, const RecordSet& run) {
  RecordSet both = together(ground, run);
  both.common_square = std::max(ground.common_square, run.common_square);
  RecordSet before = ground;
  before.common_square = both.common_square;
  Decision decision;
  decision.rivals = rivals;
  decision.chi_square.resize(rivals.size());
  for_each_in_parallel(rivals.size(), [&](std::size_t k) {
    sim::DriveDescription& model = decision.rivals[k].model;
    const double known = chi_square(model, before);
    model = refitted(model, both);
    // If the run frees a fit from a local minimum, the error on earlier records decreases too. This decrease is not
    // counted.
    decision.chi_square[k] = chi_square(model, both) - std::min(known, chi_square(model, before));
  });
  decision.dispersion = dispersion_of(decision.rivals, both);
  for (double& square : decision.chi_square) square /= decision.dispersion;
  if (table_windows(run) > 0) add_table(decision, both, before);
  decision.best = static_cast<std::size_t>(std::ranges::min_element(decision.chi_square) - decision.chi_square.begin());
  const double least = decision.chi_square[decision.best];
  const sim::Drive explanation(decision.rivals[decision.best].model);
  decision.error = error_of(explanation, run).robust;
  decision.explains = decision.error <= kFar * std::max(1.0, error_of(explanation, ground).robust);
  if (!decision.explains) {
    for (std::size_t k = 0; k < rivals.size(); ++k) decision.left.push_back(k);
    return decision;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    Rival& rival = decision.rivals[k];
    // Neither prior odds nor a run can make a rival impossible.
    rival.probability = std::max(rival.probability, 1.0 / kHighestOdds) *
                        std::max(std::exp(-0.5 * (decision.chi_square[k] - least)), 1.0 / kHighestOdds);
    sum += rival.probability;
  }
  for (Rival& rival : decision.rivals) rival.probability /= sum;
  std::vector<std::size_t> order(rivals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t k) { return decision.rivals[k].probability; });
  decision.best = order.front();
  const double best = decision.rivals[decision.best].probability;
  if (order.size() > 1) decision.odds = stated_odds(best / decision.rivals[order[1]].probability);
  for (const std::size_t k : order)
    if (decision.rivals[k].probability > best * (1.0 - kDecided) / kDecided) decision.left.push_back(k);
  return decision;
}

}  // namespace host
