// Jogs at a series of speeds in both directions, and the friction curve from them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/commission/steps.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/friction_identification.hpp"
#include "host/identify/friction_json.hpp"
#include "host/identify/plausibility.hpp"
#include "host/model/model_file.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

constexpr std::size_t kSpeeds = 6;  // speeds of one record: a train on the board holds 14 levels

/// Equally spaced on a logarithmic scale.
std::vector<double> ladder_speeds(double lowest, double highest, std::size_t count) {
  std::vector<double> speeds;
  for (std::size_t k = 0; k < count; ++k)
    speeds.push_back(lowest * std::pow(highest / lowest, static_cast<double>(k) / static_cast<double>(count - 1)));
  return speeds;
}

}  // namespace

CommissionStepResult climb_ladder(CommissionSession& session) {
  session.ask("Ladder: jogs at twelve speeds in both directions.");
  session.download(session.with_file(session.folder().require("first-params.toml", "control")));
  const double highest = std::min(session.steady_speed(), session.top_speed());
  // Below 50 counts per second the encoder's resolution is too low; a wide ladder covers a few decades.
  const double lowest = std::max(highest / 300.0, 50.0 * session.options().sheet.data.encoder_resolution);
  const std::vector<double> all = ladder_speeds(lowest, highest, 2 * kSpeeds);
  const auto middle = all.begin() + kSpeeds;
  constexpr double kSlow_s = 1.5, kFast_s = 1.0;  // duration of a jog; its first 0.3 s are ignored
  session.record(
      {"ladder-slow.csv", "ladder", {{all.begin(), middle}, {{"hold", kSlow_s}}}, "", 2.2 * kSpeeds * kSlow_s});
  session.record(
      {"ladder-fast.csv", "ladder", {{middle, all.end()}, {{"hold", kFast_s}}}, "", 2.5 * kSpeeds * kFast_s});
  session.disable();
  return {
      {"ladder-slow.csv", "ladder-fast.csv"},
      fmt::format("From {:.3g} to {:.3g} {}/s.", lowest, highest, units_of(session.options().sheet.data.kind).travel)};
}

CommissionStepResult find_friction(CommissionSession& session) {
  const sim::DriveDescription rigid = read_model(session.folder().require("identified.toml", "identify"));
  std::vector<Record> jogs;
  for (const char* file : {"ladder-slow.csv", "ladder-fast.csv"})
    jogs.push_back(read_record(session.folder().require(file, "ladder")));
  const Measurements measured = MeasurementGate(rigid).admit(std::move(jogs));
  try {
    FrictionIdentification found = identify_friction(measured, rigid, FrictionMethod::joint);
    const nlohmann::json broke = session.folder().read_json("look.json").at("pulse").at("breakaway_V");
    const bool is_levelled = level_static_friction(found.model, broke.at("positive"), broke.at("negative"));
    require_plausible(found.model, {});
    write_model(found.model, session.folder().path("model.toml"));
    session.folder().write_json("friction.json", friction_json(found));
    return {
        {"model.toml", "friction.json"},
        fmt::format("{} constant speeds determine the curve, to {:.2g} {}{}.", found.points.size(), found.fit.rms,
                    units_of(found.model.data.kind).effort, is_levelled ? "; static friction from the breakaway" : "")};
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::refused) throw;
    write_model(rigid, session.folder().path("model.toml"));
    return {{"model.toml"}, fmt::format("The friction from the steps is kept: {}.", failure.what())};
  }
}

}  // namespace host
