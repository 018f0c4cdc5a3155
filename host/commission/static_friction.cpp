#include <cmath>
#include <map>
#include <string>

#include "host/commission/steps.hpp"

namespace host {

bool level_static_friction(sim::DriveDescription& model, double forward_V, double backward_V) {
  sim::EffectEntry* stribeck = model.find("stribeck");
  if (stribeck == nullptr) return false;
  const double per_volt = model.data.effort_per_volt();
  const std::map<std::string, double> levels{{"", per_volt * 0.5 * (forward_V + backward_V)},
                                             {"_positive", per_volt * forward_V},
                                             {"_negative", -per_volt * backward_V}};
  bool is_levelled = false;
  for (const auto& [way, level] : levels) {
    const std::string fitted = "static" + way, omega1 = "omega1" + way;
    const auto interval = stribeck->ci95.find(fitted);
    if (interval == stribeck->ci95.end()) continue;
    if (interval->second[1] - interval->second[0] <= 2.0 * std::abs(stribeck->at(fitted))) continue;
    stribeck->parameters[fitted] = level;
    stribeck->parameters[omega1] = stribeck->at("omega2" + way);
    stribeck->ci95.erase(fitted);
    stribeck->ci95.erase(omega1);
    is_levelled = true;
  }
  return is_levelled;
}

}  // namespace host
