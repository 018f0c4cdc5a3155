#include "host/identify/friction_json.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/identification_json.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

nlohmann::json backward(const Estimate& magnitude) {
  return estimate_json({-magnitude.value, {-magnitude.ci95[1], -magnitude.ci95[0]}});
}

nlohmann::json parameters_json(const FrictionFit& fit, bool rotary) {
  const std::string effort = rotary ? "_Nm" : "_N", speed = rotary ? "_rad_s" : "_m_s";
  nlohmann::json parameters;
  parameters[rotary ? "B_Nm_s_per_rad" : "B_N_s_per_m"] = estimate_json(fit.viscous);
  parameters["positive" + effort] = estimate_json(fit.coulomb[0]);
  parameters["negative" + effort] = backward(fit.coulomb[1]);
  if (!fit.has_stribeck) return parameters;
  parameters["static_positive" + effort] = estimate_json(fit.static_level[0]);
  parameters["static_negative" + effort] = backward(fit.static_level[1]);
  parameters["omega1_positive" + speed] = estimate_json(fit.omega1[0]);
  parameters["omega1_negative" + speed] = backward(fit.omega1[1]);
  parameters["omega2_positive" + speed] = estimate_json(fit.omega2[0]);
  parameters["omega2_negative" + speed] = backward(fit.omega2[1]);
  return parameters;
}

nlohmann::json curve_json(const FrictionIdentification& found, const std::string& speed, const std::string& effort) {
  double slowest = HUGE_VAL, top = 0.0;
  for (const FrictionPoint& point : found.points) {
    slowest = std::min(slowest, std::abs(point.speed));
    top = std::max(top, std::abs(point.speed));
  }
  constexpr int kSteps = 60;
  nlohmann::json curve = nlohmann::json::array();
  for (const double sign : {-1.0, 1.0}) {
    for (int k = 0; k <= kSteps; ++k) {
      const double share = static_cast<double>(sign < 0.0 ? kSteps - k : k) / kSteps;
      const double w = sign * slowest * std::pow(top / slowest, share);
      curve.push_back({{speed, w}, {effort, found.fit.law.effort(w)}});
    }
  }
  return curve;
}

}  // namespace

nlohmann::json friction_json(const FrictionIdentification& found) {
  const bool rotary = found.model.data.kind == sim::DriveKind::rotary;
  const std::string speed = rotary ? "w_rad_s" : "v_m_s", effort = rotary ? "torque_Nm" : "force_N";
  nlohmann::json points = nlohmann::json::array();
  for (const FrictionPoint& point : found.points) {
    const double half = kNormal95 * point.standard_error;
    nlohmann::json entry = {{speed, point.speed},
                            {effort, point.effort},
                            {"ci95", {point.effort - half, point.effort + half}},
                            {"direction", point.speed > 0.0 ? "positive" : "negative"},
                            {"start_s", point.start_s},
                            {"duration_s", point.duration_s},
                            {"steady", point.is_steady()},
                            {"record", point.record}};
    if (point.observed_effort) entry["by_disturbance"] = *point.observed_effort;
    if (rotary) entry["turns"] = point.turns;
    points.push_back(entry);
  }
  nlohmann::json document = {{"format", "axis-friction/1"},
                             {"method", method_name(found.method)},
                             {"parameters", parameters_json(found.fit, rotary)},
                             {"rms", found.fit.rms},
                             {"observer_B", found.observer_viscous},
                             {"points", points},
                             {"curve", curve_json(found, speed, effort)},
                             {"warnings", found.warnings}};
  if (found.viscous_by_disturbance) document["B_by_disturbance"] = estimate_json(*found.viscous_by_disturbance);
  if (found.tachometer) {
    document["tachometer"] = {{"gain", estimate_json(found.tachometer->gain)},
                              {rotary ? "offset_rad_s" : "offset_m_s", estimate_json(found.tachometer->offset)}};
  }
  return document;
}

}  // namespace host
