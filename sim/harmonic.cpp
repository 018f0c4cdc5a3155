#include "sim/harmonic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

std::string harmonic_id(std::string_view family, double order) {
  return order == 1.0 ? std::string(family) : numbered_id(family, order);
}

std::vector<HarmonicTerm> harmonics_of(const EffectEntry& entry) {
  std::vector<HarmonicTerm> terms;
  for (const auto& [id, value] : entry.parameters) {
    const bool cosine = family_of(id) == "cosine";
    if (!cosine && family_of(id) != "sine") continue;
    const double order = number_of(id).value_or(1.0);
    auto term = std::ranges::find(terms, order, &HarmonicTerm::order);
    if (term == terms.end()) term = terms.insert(terms.end(), {order, 0.0, 0.0});
    (cosine ? term->cosine : term->sine) = value;
  }
  std::ranges::sort(terms, {}, &HarmonicTerm::order);
  return terms;
}

void set_harmonics(EffectEntry& entry, const std::vector<HarmonicTerm>& terms) {
  std::erase_if(entry.parameters, [](const auto& parameter) {
    const std::string_view family = family_of(parameter.first);
    return family == "cosine" || family == "sine";
  });
  for (const HarmonicTerm& term : terms) {
    entry.parameters[harmonic_id("cosine", term.order)] = term.cosine;
    entry.parameters[harmonic_id("sine", term.order)] = term.sine;
  }
}

Harmonics::Harmonics(const EffectEntry& entry) : finest_period_(entry.at("period")) {
  for (const HarmonicTerm& term : harmonics_of(entry)) {
    const double turns = std::atan2(term.sine, term.cosine) / (2.0 * std::numbers::pi);
    waves_.push_back({std::hypot(term.cosine, term.sine), turns, term.order / entry.at("period")});
    finest_period_ = std::min(finest_period_, entry.at("period") / term.order);
  }
}

}  // namespace sim
