#include "host/identify/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/exit_codes.hpp"
#include "sim/catalogue.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using Interval = std::array<double, 2>;

std::optional<Interval> interval_of(const sim::EffectEntry& entry, const std::string& id) {
  const auto found = entry.ci95.find(id);
  return found == entry.ci95.end() ? std::nullopt : std::optional<Interval>(found->second);
}

double half_width(const Interval& interval) { return 0.5 * (interval[1] - interval[0]); }

bool is_inside(double value, const sim::ParameterInfo& info) { return value >= info.lower && value <= info.upper; }

/// Parameters of either sign: components of a phase, offsets.
bool has_either_sign(const sim::ParameterInfo& info) { return info.lower < 0.0 && info.upper > 0.0; }

/// The meaning of a forbidden sign; may be empty.
std::string_view meaning_of(const sim::EffectInfo& effect, const sim::ParameterInfo& info, double value) {
  if (effect.kind == "inertia" && value <= 0.0)
    return "no mass is negative: the sign of a channel is inverted, or channels are swapped";
  const bool wrong_sign = info.lower == 0.0 ? value < 0.0 : info.upper == 0.0 && value > 0.0;
  if (effect.stage != sim::Stage::friction || !wrong_sign) return "physically impossible";
  return "friction cannot drive the axis: the sign, scale or timing of a channel is wrong, or an offset or gravity "
         "exceeds the friction (effects constant_torque, dac_offset)";
}

class Examiner {
 public:
  explicit Examiner(const sim::DriveDescription& model) : model_(model) {}

  std::vector<Doubt> examine() {
    for (const sim::EffectEntry& entry : model_.effects) {
      const sim::EffectInfo* info = sim::find_effect(entry.kind);
      if (info == nullptr) continue;
      for (const sim::ParameterInfo& parameter : info->parameters)
        if (entry.has(std::string(parameter.id))) examine(*info, parameter, entry);
      if (info->periodic) examine_amplitude(*info, entry);
    }
    examine_friction_level();
    return std::move(doubts_);
  }

 private:
  template <typename... Args>
  void doubt(std::string_view effect, bool refuses, fmt::format_string<Args...> format, Args&&... args) {
    doubts_.push_back({std::string(effect), fmt::format(format, std::forward<Args>(args)...), refuses});
  }

  void examine(const sim::EffectInfo& effect, const sim::ParameterInfo& info, const sim::EffectEntry& entry) {
    const std::string id(info.id), name = fmt::format("{}: {}", effect.kind, info.key(model_.data.kind));
    const double value = entry.at(id);
    const std::optional<Interval> interval = interval_of(entry, id);
    if (!is_inside(value, info)) {
      const bool may_be_none = interval && (*interval)[0] <= info.upper && (*interval)[1] >= info.lower;
      if (may_be_none)
        doubt(effect.kind, true,
              "{} = {:.4g} is outside {:g} … {:g}, but its interval overlaps this range: the records do not determine "
              "it; record more and stronger motion",
              name, value, info.lower, info.upper);
      else
        doubt(effect.kind, true, "{} = {:.4g}: {}", name, value, meaning_of(effect, info, value));
      return;
    }
    const bool fitted = interval.has_value() || !entry.from.empty();
    if (fitted && info.is_stopped_at(value))
      doubt(effect.kind, true,
            "{} = {:.4g} lies on a bound of the fit ({:g} … {:g}), so it is not a valid estimate: the cause is "
            "something else, or the records do not show it",
            name, value, info.lower, info.upper);
    if (!interval || has_either_sign(info) || half_width(*interval) <= std::abs(value)) return;
    const bool zero_is_allowed = info.lower == 0.0 || info.upper == 0.0;
    doubt(effect.kind, !zero_is_allowed, "{} = {:.3g} ± {:.2g}: its interval is wider than the value: {}", name, value,
          half_width(*interval), zero_is_allowed ? "it may be zero" : "the records do not determine it");
  }

  void examine_amplitude(const sim::EffectInfo& effect, const sim::EffectEntry& entry) {
    for (const sim::HarmonicTerm& term : sim::harmonics_of(entry)) {
      const auto cosine = interval_of(entry, sim::harmonic_id("cosine", term.order));
      const auto sine = interval_of(entry, sim::harmonic_id("sine", term.order));
      if (!cosine || !sine) continue;
      const double amplitude = std::hypot(term.cosine, term.sine);
      const double reach = std::hypot(half_width(*cosine), half_width(*sine));
      if (reach > amplitude)
        doubt(effect.kind, true,
              "{}: the amplitude of order {:g} is {:.3g} ± {:.2g}: it may be zero, so its phase is not determined",
              effect.kind, term.order, amplitude, reach);
    }
  }

  /// The axis could not have moved if friction were larger than the motor torque.
  void examine_friction_level() {
    const sim::EffectEntry* coulomb = model_.find("coulomb");
    const double most = model_.data.effort_per_volt() * model_.data.dac_limit_V;
    if (coulomb == nullptr || !(most > 0.0)) return;
    double level = 0.0;
    for (const char* id : {"positive", "negative", "level"})
      if (coulomb->has(id)) level = std::max(level, std::abs(coulomb->at(id)));
    if (level > most)
      doubt("coulomb", true,
            "coulomb: friction of {:.4g} {} is more than the motor gives at {:g} V ({:.4g}): the data sheet or the "
            "unit of the command is wrong",
            level, model_.data.kind == sim::DriveKind::rotary ? "Nm" : "N", model_.data.dac_limit_V, most);
  }

  const sim::DriveDescription& model_;
  std::vector<Doubt> doubts_;
};

}  // namespace

std::vector<Doubt> doubts_of(const sim::DriveDescription& model) { return Examiner(model).examine(); }

std::vector<std::string> messages_of(const std::vector<Doubt>& doubts) {
  std::vector<std::string> messages;
  for (const Doubt& doubt : doubts) messages.push_back(doubt.message);
  return messages;
}

void keep_within_bounds(sim::EffectEntry& entry, sim::DriveKind kind, std::vector<std::string>& warnings) {
  const sim::EffectInfo& info = *sim::find_effect(entry.kind);
  for (auto& [id, value] : entry.parameters) {
    const sim::ParameterInfo* const parameter = info.parameter(id);
    if (parameter == nullptr) continue;  // a numbered parameter, which may have either sign
    const double bound = std::clamp(value, parameter->lower, parameter->upper);
    if (value == bound) continue;
    warnings.push_back(
        fmt::format("the model uses {} = {:g}, the nearest possible value", parameter->key(kind), bound));
    value = bound;
    entry.ci95.erase(id);
  }
}

void require_plausible(const sim::DriveDescription& model, const std::vector<std::string>& accepted) {
  for (const Doubt& doubt : doubts_of(model)) {
    if (!doubt.refuses || std::ranges::find(accepted, doubt.effect) != accepted.end()) continue;
    throw Failure(ExitCode::refused,
                  fmt::format("model '{}': {}. No controller is designed from it; override with --accept {}",
                              model.name, doubt.message, doubt.effect));
  }
}

}  // namespace host
