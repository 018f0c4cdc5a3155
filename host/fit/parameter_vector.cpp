#include "host/fit/parameter_vector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/catalogue.hpp"
#include "sim/curve.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

/// Parameters of one direction that may be set equal in a model.
const std::vector<std::pair<std::string, std::string>> kMayBeEqual = {
    {"omega1_positive", "omega2_positive"}, {"omega1_negative", "omega2_negative"}, {"omega1", "omega2"}};

const std::string* partner_of(const std::string& id) {
  const auto found = std::ranges::find(kMayBeEqual, id, &std::pair<std::string, std::string>::first);
  return found == kMayBeEqual.end() ? nullptr : &found->second;
}

/// A contact that breaks away within a micrometre behaves as rigid, but takes thousands of steps to simulate.
constexpr double kShortestBreakaway_mm = 1e-3;

/// Below a few tenths of a millimetre per second (lubricated guides: 0.5 to 10 mm/s) a Stribeck curve is a step. A fit
/// cannot leave it again, because the error no longer depends on the speeds of the curve.
constexpr double kSlowestFading_mm_s = 0.3;

/// Stiffness of a contact that breaks away over the shortest distance, Nm/rad or N/m.
double stiffest_contact(const sim::DriveDescription& description) {
  const sim::EffectEntry* coulomb = description.find("coulomb");
  if (coulomb == nullptr) return HUGE_VAL;
  double level = 0.0;
  for (const auto& [id, value] : coulomb->parameters) level = std::max(level, std::abs(value));
  const double millimetre = description.data.kind == sim::DriveKind::rotary ? 1.0 : 1e-3;
  return level * description.data.lead / (kShortestBreakaway_mm * millimetre);
}

/// The parameters of an entry in the catalogue's order; all orders of a period stay together.
std::vector<std::string> ids_in_order(const sim::EffectInfo& info, const sim::EffectEntry& entry) {
  std::vector<std::string> ids;
  for (const sim::ParameterInfo& parameter : info.parameters)
    for (const auto& [id, value] : entry.parameters)
      if (info.parameter(id) == &parameter) ids.push_back(id);
  return ids;
}

/// Lower bound of the speeds of a Stribeck curve, rad/s or m/s.
double slowest_fading(const sim::DriveDescription& description) {
  const double millimetre = description.data.kind == sim::DriveKind::rotary ? 1.0 : 1e-3;
  return kSlowestFading_mm_s * millimetre / description.data.lead;
}

}  // namespace

std::string FreeParameter::name(const sim::DriveDescription& description) const {
  return fmt::format("{}.{}", description.effects[effect].kind, entries.front().first);
}

ParameterVector::ParameterVector(const sim::DriveDescription& description, Freedom freedom) {
  const bool only_last = freedom == Freedom::last_effect;
  for (std::size_t index = only_last ? description.effects.size() - 1 : 0; index < description.effects.size();
       ++index) {
    const sim::EffectEntry& entry = description.effects[index];
    const sim::EffectInfo& info = *sim::find_effect(entry.kind);
    std::vector<std::string> taken;
    for (const std::string& id : ids_in_order(info, entry)) {
      const sim::ParameterInfo& parameter = *info.parameter(id);
      if (std::ranges::find(taken, id) != taken.end() || entry.held.contains(id) ||
          parameter.scale == sim::Scale::first_stamp || (info.curve && sim::family_of(id) == "knot"))
        continue;
      if (only_last && id == "period") continue;
      const double value = entry.at(id);
      const double magnitude = std::abs(value);
      FreeParameter free{index, {{id, 1.0}}, magnitude, parameter.lower, parameter.upper};
      if (parameter.scale == sim::Scale::bristle_stiffness)
        free.upper = std::max(magnitude, std::min(free.upper, stiffest_contact(description)));
      if (parameter.scale ==
          sim::Scale::converter_range) {  // at most half of the range, because the rest must move the axis
        const double most = std::max(magnitude, 0.5 * description.data.dac_limit_V);
        free.lower = std::max(free.lower, -most);
        free.upper = std::min(free.upper, most);
      }
      if (id.starts_with("static")) {  // at most the drive's limit, because the axis has moved
        const double most = std::max(magnitude, description.data.dac_limit_V * description.data.effort_per_volt());
        free.lower = std::max(free.lower, -most);
        free.upper = std::min(free.upper, most);
      }
      if (id.starts_with("omega") && magnitude > 0.0) {
        const double slowest = std::min(magnitude, slowest_fading(description));
        (value > 0.0 ? free.lower : free.upper) = value > 0.0 ? slowest : -slowest;
      }
      const std::string* partner = partner_of(id);
      if (partner != nullptr && entry.has(*partner) && entry.at(*partner) == value) {
        free.entries.emplace_back(*partner, 1.0);
        taken.push_back(*partner);
      }
      if (info.curve && id == "value_0" && sim::Curve(entry).period() > 0.0) {
        const std::size_t last = sim::Curve(entry).values().size() - 1;
        free.entries.emplace_back(sim::numbered_id("value", static_cast<double>(last)), 1.0);
        taken.push_back(free.entries.back().first);
      }
      if (info.periodic && id != "period") {  // the amplitude, which does not depend on the phase
        const double order = sim::number_of(id).value_or(1.0);
        free.scale = std::hypot(entry.at(sim::harmonic_id("cosine", order)), entry.at(sim::harmonic_id("sine", order)));
      }
      if (const auto belief = entry.believed.find(id); belief != entry.believed.end()) free.believed = belief->second;
      if (free.scale <= 0.0) free.scale = 1e-3 * std::min(1.0, parameter.upper - parameter.lower);
      parameters_.push_back(std::move(free));
    }
  }
}

Eigen::VectorXd ParameterVector::read(const sim::DriveDescription& description) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(size()));
  for (std::size_t k = 0; k < size(); ++k) {
    const auto& [id, sign] = parameters_[k].entries.front();
    values(static_cast<Eigen::Index>(k)) = sign * description.effects[parameters_[k].effect].at(id);
  }
  return values;
}

void ParameterVector::write(const Eigen::VectorXd& values, sim::DriveDescription& description) const {
  for (std::size_t k = 0; k < size(); ++k) {
    const FreeParameter& free = parameters_[k];
    const double value = std::clamp(values(static_cast<Eigen::Index>(k)), free.lower, free.upper);
    for (const auto& [id, sign] : free.entries) description.effects[free.effect].parameters[id] = sign * value;
  }
}

}  // namespace host
