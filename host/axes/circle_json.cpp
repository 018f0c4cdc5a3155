#include <algorithm>
#include <cmath>

#include "host/axes/circle_diagnosis.hpp"

namespace host {

namespace {

nlohmann::json optional_json(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json findings_json(const std::vector<CircleFinding>& findings) {
  using nlohmann::json;
  json list = json::array();
  for (const CircleFinding& found : findings) {
    json instead = json::object();
    for (const auto& [name, probability] : found.instead) instead[name] = probability;
    list.push_back({{"kind", found.cause.kind},
                    {"axis", found.cause.axis},
                    {"um", found.um},
                    {"ci95", found.ci95},
                    {"probability", found.probability},
                    {"amount", {{"value", found.amount}, {"unit", found.cause.amount_unit}}},
                    {"period_mm", optional_json(found.cause.period_mm)},
                    {"period_turns", optional_json(found.period_turns)},
                    {"frequency_Hz", optional_json(found.cause.frequency_Hz)},
                    {"instead", instead},
                    {"next", cause_text(found.cause.kind).next}});
  }
  return list;
}

}  // namespace

nlohmann::json circle_json(const CircleDiagnosis& diagnosis) {
  using nlohmann::json;
  json unseen = json::array(), why = json::object(), passes = json::array();
  for (const Unseen& one : diagnosis.unseen) {
    unseen.push_back(one.kind);
    why[one.kind] = one.why;
  }
  double G = 0.0, F_max = -HUGE_VAL, F_min = HUGE_VAL;
  for (std::size_t i = 0; i < diagnosis.passes.size(); ++i) {
    const CirclePass& pass = diagnosis.passes[i];
    const CircleFigures& figures = diagnosis.figures[i];
    passes.push_back({{"source", pass.source},
                      {"direction", pass.is_ccw ? "ccw" : "cw"},
                      {"feed_mm_s", pass.feed_mm_s},
                      {"radius_mm", pass.radius_mm},
                      {"G_um", figures.G_um},
                      {"F_max_um", figures.F_max_um},
                      {"F_min_um", figures.F_min_um}});
    G = std::max(G, figures.G_um);
    F_max = std::max(F_max, figures.F_max_um);
    F_min = std::min(F_min, figures.F_min_um);
  }
  json iso = {{"G_um", G},         {"Gb_um", nullptr},  {"F_um", std::max(std::abs(F_max), std::abs(F_min))},
              {"F_max_um", F_max}, {"F_min_um", F_min}, {"H_um", nullptr}};
  if (diagnosis.both) {
    iso["Gb_um"] = diagnosis.both->Gb_um;
    iso["H_um"] = diagnosis.both->H_um;
  }
  return {{"format", "axis-circle/1"},
          {"causes", findings_json(diagnosis.causes)},
          {"minor", findings_json(diagnosis.minor)},
          {"cannot_see", unseen},
          {"cannot_see_why", why},
          {"iso_230_4", iso},
          {"passes", passes},
          {"rest_um", diagnosis.rest_um}};
}

}  // namespace host
