#include "host/model/effect_forms.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"
#include "sim/catalogue.hpp"

namespace host {

std::vector<std::string_view> ids_of_pair(const sim::ParameterInfo& both) {
  std::vector<std::string_view> ids;
  std::string_view rest = both.pair_of;
  while (!rest.empty()) {
    const std::size_t blank = rest.find(' ');
    ids.push_back(rest.substr(0, blank));
    rest.remove_prefix(blank == std::string_view::npos ? rest.size() : blank + 1);
  }
  return ids;
}

bool may_repeat(const sim::EffectInfo& info) { return info.periodic || info.curve || info.kind == "external_torque"; }

std::vector<std::string_view> effect_kinds() {
  std::vector<std::string_view> kinds;
  for (const sim::EffectInfo* info : sim::catalogue()) kinds.push_back(info->kind);
  return kinds;
}

const sim::EffectInfo& known_effect(std::string_view kind) {
  if (const sim::EffectInfo* info = sim::find_effect(kind)) return *info;
  throw Failure(ExitCode::usage, fmt::format("effect '{}' is unknown{}; `axistool effects` lists all kinds", kind,
                                             did_you_mean(kind, effect_kinds())));
}

bool holds(const std::array<double, 2>& interval, double value) {
  const double rounding = 1e-9 * std::abs(value);
  return interval[0] - rounding <= value && value <= interval[1] + rounding;
}

}  // namespace host
