// Steps of voltage in open loop, and what they say of inertia and friction.
#include <fmt/format.h>

#include "host/commission/steps.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/identification_json.hpp"
#include "host/model/model_file.hpp"
#include "host/read_file.hpp"
#include "host/record/read_record.hpp"

namespace host {

CommissionStepResult identify_first(CommissionSession& session) {
  session.ask("Identify: steps of voltage to and fro.");
  constexpr double kTime_s = 10.0;
  const Record steps = session.record({"steps.csv", "steps", {}, "", kTime_s});
  const Measurements measured = MeasurementGate(session.options().sheet).admit({steps});
  Identification found = identify_drive(measured, session.options().sheet, default_method(measured.training()));
  found.model.name = session.options().axis_name;
  write_model(found.model, session.folder().path("identified.toml"));
  session.folder().write_json("identification.json", identification_json(found));
  const bool rotary = found.model.data.kind == sim::DriveKind::rotary;
  std::string said = fmt::format("{} {:.3g} {}, viscous friction {:.3g} {}; what is left of the {} is {:.1f} %.",
                                 rotary ? "Inertia" : "Mass", found.estimate.inertia.value, rotary ? "kg m²" : "kg",
                                 found.estimate.viscous.value, rotary ? "Nm s/rad" : "N s/m",
                                 rotary ? "torque" : "force", 100.0 * found.relative_error);
  for (const std::string& warning : found.warnings) said += " Note: " + warning + ".";
  return {{"steps.csv", "identified.toml", "identification.json"}, said};
}

}  // namespace host
