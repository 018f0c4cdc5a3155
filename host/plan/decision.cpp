#include "host/plan/decision.hpp"

#include <algorithm>
#include <cmath>

#include "host/diagnose/parallel.hpp"

namespace host {

Decision decide(const std::vector<Rival>& rivals, const std::vector<const Record*>& training, const Record& run) {
  return decide_on(rivals, common_ground(training, rivals), common_ground({&run}, rivals));
}

Decision decide_on(const std::vector<Rival>& rivals, const RecordSet& ground, const RecordSet& run) {
  RecordSet both = joined(ground, run);
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
    decision.chi_square[k] = chi_square(model, both) - known;
  });
  const double least = *std::ranges::min_element(decision.chi_square);
  double sum = 0.0;
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    Rival& rival = decision.rivals[k];
    rival.probability *= std::max(std::exp(-0.5 * (decision.chi_square[k] - least)), 1.0 / kHighestOdds);
    sum += rival.probability;
  }
  for (Rival& rival : decision.rivals) rival.probability /= sum;
  const auto by_probability = [&](std::size_t a, std::size_t b) {
    return decision.rivals[a].probability > decision.rivals[b].probability;
  };
  std::vector<std::size_t> order(rivals.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, by_probability);
  decision.best = order.front();
  const double best = decision.rivals[decision.best].probability;
  if (order.size() > 1) decision.odds = std::min(kHighestOdds, best / decision.rivals[order[1]].probability);
  for (const std::size_t k : order)
    if (decision.rivals[k].probability > best * (1.0 - kDecided) / kDecided || k == decision.best)
      decision.left.push_back(k);
  decision.error = error_of(sim::Drive(decision.rivals[decision.best].model), run).combined;
  return decision;
}

}  // namespace host
