#include "host/identify/identification_json.hpp"

namespace host {

nlohmann::json estimate_json(const Estimate& estimate) {
  return {{"value", estimate.value}, {"ci95", {estimate.ci95[0], estimate.ci95[1]}}};
}

nlohmann::json identification_json(const Identification& identification) {
  const bool rotary = identification.model.data.kind == sim::DriveKind::rotary;
  const RigidEstimate& estimate = identification.estimate;
  nlohmann::json parameters;
  parameters[rotary ? "J_kg_m2" : "M_kg"] = estimate_json(estimate.inertia);
  parameters[rotary ? "B_Nm_s_per_rad" : "B_N_s_per_m"] = estimate_json(estimate.viscous);
  if (estimate.positive) parameters[rotary ? "positive_Nm" : "positive_N"] = estimate_json(*estimate.positive);
  if (estimate.negative) parameters[rotary ? "negative_Nm" : "negative_N"] = estimate_json(*estimate.negative);
  nlohmann::json document = {
      {"format", "axis-identification/1"},
      {"for", "control"},
      {"method", method_name(identification.method)},
      {"relative_error", identification.relative_error},
      {"motion_from", identification.by_speed ? "speed" : "position"},
      {"beside_travel", identification.beside_travel},
      {"parameters", parameters},
      {"condition_number", estimate.condition_number},
      {"filter", {{"cutoff_Hz", identification.cutoff_Hz}, {"decimation", identification.decimation}}},
      {"excitation",
       {{"forward_s", identification.excitation.forward_s},
        {"backward_s", identification.excitation.backward_s},
        {rotary ? "top_speed_rad_s" : "top_speed_m_s", identification.excitation.top_speed},
        {rotary ? "peak_effort_Nm" : "peak_effort_N", identification.excitation.peak_effort}}},
      {"warnings", identification.warnings}};
  if (identification.tachometer) {
    document["tachometer"] = {
        {"gain", estimate_json(identification.tachometer->gain)},
        {rotary ? "offset_rad_s" : "offset_m_s", estimate_json(identification.tachometer->offset)}};
  }
  if (identification.tach_noise_variance) {
    document["tachometer"][rotary ? "noise_variance_rad2_s2" : "noise_variance_m2_s2"] =
        *identification.tach_noise_variance;
  }
  if (const auto& amplifier = identification.amplifier)
    document["amplifier"] = {{"Ka_A_per_V", estimate_json(amplifier->gain)},
                             {"offset_A", amplifier->offset_A},
                             {"relative_residual", amplifier->relative_residual},
                             {"used_A_per_V", identification.model.data.amplifier_gain_A_per_V}};
  if (const auto& check = identification.gain_check)
    document["gain_check"] = {{"added", check->added},
                              {"grown", check->grown},
                              {"factor", estimate_json(check->factor)},
                              {rotary ? "J_kg_m2" : "M_kg", estimate_json(check->inertia)},
                              {"assumed", check->assumed},
                              {"found", check->found}};
  return document;
}

}  // namespace host
