// Voltage steps in open loop; identifies inertia and friction from them.
#include <fmt/format.h>

#include <algorithm>

#include "host/commission/steps.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/identification_json.hpp"
#include "host/identify/plausibility.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

/// If the fitted friction level is impossible, an unknown effect has biased it. Then the breakaway voltage gives the
/// level, until the ladder does. Returns whether that was needed.
bool level_friction(CommissionSession& session, sim::DriveDescription& model) {
  const std::vector<Doubt> doubts = doubts_of(model);
  if (std::ranges::none_of(doubts, [](const Doubt& doubt) { return doubt.effect == "coulomb" && doubt.refuses; }))
    return false;
  const nlohmann::json broke = session.folder().read_json("look.json").at("pulse").at("breakaway_V");
  constexpr double kSliding = 0.8;  // sliding friction relative to breakaway
  const double per_volt = kSliding * model.data.effort_per_volt();
  sim::EffectEntry& coulomb = *model.find("coulomb");
  coulomb = {"coulomb",
             {{"positive", per_volt * broke.at("positive").get<double>()},
              {"negative", -per_volt * broke.at("negative").get<double>()}},
             {},
             "pulse.csv"};
  return true;
}

}  // namespace

Record record_steps(CommissionSession& session) {
  constexpr double kTime_s = 10.0;
  return session.record({"steps.csv", "steps", {}, "", kTime_s});
}

CommissionStepResult identify_first(CommissionSession& session) {
  session.ask("Identify: voltage steps in both directions.");
  const Record steps = record_steps(session);
  const Measurements measured = MeasurementGate(session.options().sheet).admit({steps});
  Identification found = identify_drive(measured, session.options().sheet, default_method(measured.training()));
  found.model.name = session.options().axis_name;
  const bool is_levelled = level_friction(session, found.model);
  write_model(found.model, session.folder().path("identified.toml"));
  session.folder().write_json("identification.json", identification_json(found));
  const bool rotary = found.model.data.kind == sim::DriveKind::rotary;
  std::string said =
      fmt::format("{} {:.3g} {}, viscous friction {:.3g} {}; residual {} {:.1f} %.", rotary ? "Inertia" : "Mass",
                  found.estimate.inertia.value, rotary ? "kg m²" : "kg", found.estimate.viscous.value,
                  rotary ? "Nm s/rad" : "N s/m", rotary ? "torque" : "force", 100.0 * found.relative_error);
  if (is_levelled)
    said += " The fitted Coulomb friction is physically impossible, so the breakaway level is used for now.";
  for (const std::string& warning : found.warnings) said += " Note: " + warning + ".";
  return {{"steps.csv", "identified.toml", "identification.json"}, said};
}

}  // namespace host
