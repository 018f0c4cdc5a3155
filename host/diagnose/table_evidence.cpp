#include "host/diagnose/table_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/diagnose/connection.hpp"
#include "host/infer/posterior.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

bool contains(const std::vector<std::string>& list, std::string_view name) {
  return std::ranges::find(list, name) != list.end();
}

bool in_a_group(const TableStudy& study, std::string_view kind) {
  return std::ranges::any_of(study.effects, [&](const TableEffect& effect) { return contains(effect.group, kind); });
}

bool is_denied(const TableStudy& study, std::string_view kind) {
  const std::optional<double> probability = study.probability(kind);
  return probability && *probability <= 1.0 - kClaimed && !in_a_group(study, kind);
}

/// Whether the table shows that a connection is absent or too small to be named.
bool is_too_small(const TableStudy& study, std::string_view kind) {
  const TableEffect* effect = study.find(kind);
  return is_denied(study, kind) || (effect != nullptr && !effect->worth_naming);
}

/// The connection that the motion names, if the table names the other one. Then neither is certain.
std::optional<std::string> other_connection(const TableStudy& study, const DiagnosisVerdict& verdict) {
  if (verdict.status != Status::missing) return {};
  for (const std::string_view kind : kConnections)
    if (study.find(kind) != nullptr)
      for (const std::string& named : verdict.effects)
        if (is_connection(named) && named != kind && study.find(named) == nullptr) return named;
  return {};
}

/// Removes effects that the table excludes from the named ones and the groups. If one effect of a group remains, it is
/// named.
void take_back(const TableStudy& study, DiagnosisVerdict& verdict) {
  const auto contradicted = [&](const std::string& kind) { return is_connection(kind) && is_denied(study, kind); };
  const bool group_was_named = verdict.status == Status::ambiguous;
  std::erase_if(verdict.effects, contradicted);
  for (std::vector<std::string>& group : verdict.alternatives) {
    std::erase_if(group, contradicted);
    if (group.size() == 1 && !group_was_named && !contains(verdict.effects, group.front()))
      verdict.effects.push_back(group.front());
  }
  std::erase_if(verdict.alternatives, [](const std::vector<std::string>& group) { return group.size() < 2; });
  if (group_was_named && verdict.effects.size() == 1) verdict.status = Status::missing;
}

}  // namespace

std::vector<std::string> absent_by_table(const TableStudy& study) {
  if (study.empty() || !study.rows.has_effort()) return {};
  for (const std::string_view kind : kConnections)
    if (!is_too_small(study, kind)) return {};
  return {kConnections.begin(), kConnections.end()};
}

void settle_by_table(const TableStudy& study, Diagnosis& diagnosis) {
  if (study.empty()) return;
  DiagnosisVerdict& verdict = diagnosis.verdict;
  std::optional<std::string> rival;
  if (study.rows.has_effort()) {
    rival = other_connection(study, verdict);
    take_back(study, verdict);
  }
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> groups;
  for (const TableEffect& effect : study.effects) {
    if (study.before_um > 0.0)
      verdict.found.push_back(
          {effect.group, effect.probability, effect.before / study.before_um, effect.after / study.before_um});
    if (!effect.worth_naming) continue;
    if (effect.group.size() > 1)
      groups.push_back(effect.group);
    else if (rival && is_connection(effect.kind()))
      groups.push_back({effect.kind(), *rival});
    else if (!contains(names, effect.kind()))
      names.push_back(effect.kind());
    if (!effect.entry.parameters.empty() && !effect.place.starts_with("scale"))
      diagnosis.best.effects.push_back(effect.entry);
  }
  verdict.explanation = table_words(study) + " " + verdict.explanation;
  std::erase_if(verdict.alternatives, [&](const std::vector<std::string>& group) {
    return std::ranges::any_of(group, [&](const std::string& kind) { return contains(names, kind); });
  });
  if (names.empty() && groups.empty()) return;
  if (verdict.status == Status::missing)
    for (const std::string& kind : verdict.effects)
      if (!contains(names, kind)) names.push_back(kind);
  verdict.alternatives.insert(verdict.alternatives.end(), groups.begin(), groups.end());
  verdict.status = names.empty() ? Status::ambiguous : Status::missing;
  verdict.effects = names.empty() ? groups.front() : std::move(names);
}

std::string advice_on_a_scale(const DiagnosisVerdict& verdict) {
  const auto speaks_of = [&](std::string_view kind) {
    return contains(verdict.effects, kind) ||
           std::ranges::any_of(verdict.alternatives,
                               [&](const std::vector<std::string>& group) { return contains(group, kind); });
  };
  if (std::ranges::none_of(kConnections, speaks_of)) return {};
  return " A scale on the table (column x2_mm) decides: with backlash the table stands still until the motor has "
         "crossed the gap, at any force; with a spring it lags in proportion to the force; if it follows the motor, "
         "it is neither. A dial gauge at reversals (axistool dial) shows whether it is one of them.";
}

}  // namespace host
