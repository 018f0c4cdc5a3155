#include "host/search/pattern_search.hpp"

#include <algorithm>
#include <cmath>

#include "sim/catalogue.hpp"

namespace host {

sim::DriveDescription pattern_search(const sim::DriveDescription& model, const RecordSet& set, double most_steps) {
  constexpr double kFirstFactor = 1.25, kLastFactor = 1.02;
  constexpr int kMostRounds = 40;
  const sim::EffectInfo& info = *sim::find_effect(model.effects.back().kind);
  sim::DriveDescription best = model;
  double steps = 0.0;
  const auto error_at = [&](const sim::DriveDescription& there) {
    const sim::Drive drive(there);
    steps += steps_of(drive, set);
    return error_of(drive, set).robust;
  };
  double error = error_at(best);
  double factor = kFirstFactor;
  for (int round = 0; round < kMostRounds && factor > kLastFactor && steps < most_steps; ++round) {
    bool better = false;
    for (const auto& [id, value] : model.effects.back().parameters) {
      const sim::ParameterInfo& parameter = *info.parameter(id);
      for (const double step : {factor, 1.0 / factor}) {
        sim::DriveDescription moved = best;
        double& here = moved.effects.back().parameters[id];
        here = std::clamp(here * step, parameter.lower, parameter.upper);
        const double there = error_at(moved);
        if (there >= error) continue;
        error = there;
        best = std::move(moved);
        better = true;
        break;
      }
    }
    if (!better) factor = std::sqrt(factor);
  }
  return best;
}

}  // namespace host
