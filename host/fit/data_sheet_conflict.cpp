#include "host/fit/data_sheet_conflict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/fit/model_fit.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

constexpr double kFarOff = 2.0;
constexpr double kWantsToMove = 0.1;
constexpr double kLeastGainOfFreed = 0.05;
constexpr std::size_t kWindowsOfCheck = 200;

std::string name_of(const sim::EffectEntry& entry, const std::string& id, sim::DriveKind kind) {
  return fmt::format("{} {}", entry.kind, sim::find_effect(entry.kind)->parameter(id)->key(kind));
}

}  // namespace

std::vector<DataSheetConflict> data_sheet_conflicts(const sim::DriveDescription& fitted, const RecordSet& set) {
  std::vector<DataSheetConflict> conflicts;
  bool holds = false;
  for (const sim::EffectEntry& entry : fitted.effects) {
    holds = holds || !entry.held.empty();
    for (const auto& [id, belief] : entry.believed) {
      const double off = std::abs(entry.at(id) - belief.value) / belief.deviation;
      if (off <= kFarOff || entry.held.contains(id)) continue;
      const std::string name = name_of(entry, id, fitted.data.kind);
      conflicts.push_back({name, belief.value, entry.at(id),
                           fmt::format("The data contradict the data sheet: {} is estimated as {:.4g}, {:.1f} standard "
                                       "deviations from the prior {:.4g} ± {:.2g}.",
                                       name, entry.at(id), off, belief.value, belief.deviation)});
    }
  }
  if (!holds || set.records.empty()) return conflicts;
  sim::DriveDescription free = fitted;
  for (sim::EffectEntry& entry : free.effects) entry.held.clear();
  RecordSet few = set;
  few.stride = std::max<std::size_t>(few.stride, set.used_windows() / kWindowsOfCheck);
  free = fit_model(free, few).model;
  const double before = error_of(sim::Drive(fitted), few).robust, after = error_of(sim::Drive(free), few).robust;
  if (!(after < (1.0 - kLeastGainOfFreed) * before)) return conflicts;
  for (std::size_t k = 0; k < fitted.effects.size(); ++k)
    for (const std::string& id : fitted.effects[k].held) {
      const double known = fitted.effects[k].at(id), wanted = free.effects[k].at(id);
      if (std::abs(wanted - known) <= kWantsToMove * std::abs(known)) continue;
      const std::string name = name_of(fitted.effects[k], id, fitted.data.kind);
      conflicts.push_back({name, known, wanted,
                           fmt::format("The data contradict the data sheet: {} is held at {:.4g}; a free fit gives "
                                       "{:.4g}, and the error is {:.0f} % lower.",
                                       name, known, wanted, 100.0 * (1.0 - after / before))});
    }
  return conflicts;
}

}  // namespace host
