#include "host/diagnose/claim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/compare/chance.hpp"
#include "host/diagnose/probability.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Of the bootstrap over blocks of validation windows: one in twenty, since gain and share below keep luck out (the
/// luckiest candidate never came near them); on a rough machine, where share asks for little, one in a hundred.
constexpr double kLeastConfidence = 0.95;
constexpr double kLeastRoughConfidence = 0.99;
/// Part of what there is to explain below which an effect is no explanation.
constexpr double kLeastShare = 0.35;
/// The same on a rough machine, whose residual has many small causes.
constexpr double kLeastRoughShare = 0.1;
/// An effect that is really there leaves 2 % of the error (impacts and breakaways that come a moment late), two of
/// three some 15 %; what made up for things that no catalogue knows left 40 % and more, two that bend friction to a
/// shape of nobody's formula 20 %. Not asked on a rough machine.
constexpr double kMostLeft = 0.15;
/// An error, over floor, from which on there is something to explain at all.
constexpr double kSomething = 1.1;

bool gains(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  // Where the base is more probably complete than not, whatever improves on it is none.
  if (std::max(candidate.before, diagnosis.before_train) < ProbabilityScale{}.complete) return false;
  const double least = diagnosis.rough ? kLeastRoughShare : kLeastShare;
  const auto on = [&](double before, double after) {
    return before > kSomething && after < (1.0 - kLeastGain) * before && explained_share(before, after) >= least;
  };
  return on(candidate.before, candidate.after) && (on(diagnosis.before_train, candidate.train_after) ||
                                                   on(diagnosis.before_train_robust, candidate.train_after_robust));
}

}  // namespace

double explained_share(double before, double after) {
  const double there_is = before * before - kComplete * kComplete;
  return there_is > 0.0 ? std::clamp((before * before - after * after) / there_is, 0.0, 1.0) : 0.0;
}

double explained_in_training(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  return std::max(explained_share(diagnosis.before_train, candidate.train_after),
                  explained_share(diagnosis.before_train_robust, candidate.train_after_robust));
}

std::size_t parameters_of(const JudgedCandidate& candidate) {
  std::size_t count = 0;
  for (const std::string& kind : candidate.kinds)
    if (const sim::EffectEntry* entry = candidate.model.find(kind)) count += entry->parameters.size();
  return count;
}

std::vector<std::string> parameters_on_bound(const sim::DriveDescription& model,
                                             const std::vector<std::string>& kinds) {
  constexpr double kNear = 1e-3;
  constexpr double kStandsForZero = 0.005;  // of the upper end
  std::vector<std::string> found;
  for (const std::string& kind : kinds) {
    const sim::EffectEntry* entry = model.find(kind);
    if (entry == nullptr) continue;
    for (const auto& [id, value] : entry->parameters) {
      const sim::ParameterInfo* info = sim::find_effect(kind)->parameter(id);
      if (info == nullptr) continue;
      const bool on_one =
          std::ranges::any_of(std::array{info->lower, info->upper}, [info, value = value](double bound) {
            return std::abs(bound) > kStandsForZero * std::abs(info->upper) && std::isfinite(bound) &&
                   std::abs(value - bound) <= kNear * std::abs(bound);
          });
      if (on_one) found.push_back(fmt::format("{}: {}", kind, info->key(model.data.kind)));
    }
  }
  return found;
}

Reservation reservation_about(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  if (!gains(candidate, diagnosis)) return Reservation::no_gain;
  if (!candidate.on_bound.empty()) return Reservation::on_bound;
  if (!diagnosis.rough && (explained_share(candidate.before, candidate.after) < 1.0 - kMostLeft ||
                           explained_in_training(candidate, diagnosis) < 1.0 - kMostLeft))
    return Reservation::leaves_much;
  if (candidate.luck > kMostLuck || candidate.confidence < (diagnosis.rough ? kLeastRoughConfidence : kLeastConfidence))
    return Reservation::luck;
  return Reservation::none;
}

double least_validation_s(std::size_t tried) {
  // All of m blocks improve by luck with probability 2^-m.
  return kLuckBlock_s * std::ceil(std::log2(static_cast<double>(std::max<std::size_t>(1, tried)) / kMostLuck));
}

}  // namespace host
