#include "host/search/physical_range.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/search/candidate_starts.hpp"
#include "sim/catalogue.hpp"

namespace host {

std::vector<std::string> parameters_on_bound(const sim::DriveDescription& model,
                                             const std::vector<std::string>& kinds) {
  std::vector<std::string> found;
  for (const std::string& kind : kinds) {
    const sim::EffectEntry* entry = model.find(kind);
    if (entry == nullptr) continue;
    for (const auto& [id, value] : entry->parameters) {
      const sim::ParameterInfo* info = sim::find_effect(kind)->parameter(id);
      if (info != nullptr && info->is_stopped_at(value))
        found.push_back(fmt::format("{}: {}", kind, info->key(model.data.kind)));
    }
  }
  return found;
}

std::vector<std::string> unphysical_parameters(const sim::DriveDescription& model,
                                               const std::vector<std::string>& kinds, const RecordSet& training) {
  constexpr double kFarthest = 10.0;  // travels: over one travel the effect changes by a tenth, as kWorthNaming asks
  std::vector<std::string> found = parameters_on_bound(model, kinds);
  for (const std::string& kind : kinds) {
    const sim::EffectEntry* entry = model.find(kind);
    if (entry == nullptr) continue;
    for (const auto& [id, value] : entry->parameters) {
      const sim::ParameterInfo* info = sim::find_effect(kind)->parameter(id);
      if (info == nullptr || info->scale != sim::Scale::position) continue;
      const RecordScales scales = scales_of(training);
      if (std::abs(value - scales.middle) > kFarthest * scales.travel)
        found.push_back(fmt::format("{}: {}", kind, info->key(model.data.kind)));
    }
  }
  return found;
}

}  // namespace host
