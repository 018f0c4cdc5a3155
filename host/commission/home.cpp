// Homing: effects that depend on position can be compensated only on a homed axis.
#include <fmt/format.h>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/commission/steps.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/record/drive_units.hpp"

namespace host {

namespace {

constexpr double kSearchOfBox = 0.45;  ///< search towards the switch relative to the box's travel, with room to stop
constexpr double kSpeedOfBox = 0.15;

}  // namespace

bool CommissionSession::can_home() {
  if (options_.homing) return options_.homing->mode != firmware::HomingMode::none;
  return board_.read_values().axis(options_.axis).get<"homing.mode">() != 0;
}

bool CommissionSession::is_homed() {
  return (board_.status().axis.at(options_.axis).flags & firmware::kAxisHomed) != 0;
}

std::vector<CompensationParameter> CommissionSession::homing_parameters() const {
  if (!options_.homing) return {};
  const sim::DataSheet& sheet = options_.sheet.data;
  const double speed = kSpeedOfBox * options_.box.speed, way = kSearchOfBox * options_.box.travel;
  const double turn = sheet.kind == sim::DriveKind::rotary ? sheet.turn() : way;
  return {{"homing.mode", static_cast<double>(options_.homing->mode)},
          {"homing.velocity", options_.homing->is_backward ? -speed : speed},
          {"homing.creep_velocity", speed / 10.0},
          {"homing.travel", way},
          {"homing.index_travel", 1.2 * turn},
          {"homing.position", options_.homing->position}};
}

void CommissionSession::find_home() {
  const auto begin = board_.now();
  enable();
  go_back();  // a search may take up to half of the box's travel
  std::int64_t last = counts();
  home_and_wait(board_, options_.axis, [&] {
    const auto status = board_.status().axis.at(options_.axis);
    if ((status.flags & firmware::kAxisHomed) == 0) last = status.counts();
    return talk_.stop();
  });
  spend(begin);
  if (talk_.stop()) throw Failure(ExitCode::refused, "interrupted");
  origin_ += counts() - last;  // the same position, counted from home
}

CommissionStepResult home_axis(CommissionSession& session) {
  session.folder().put("homed", false);
  if (!session.can_home())
    return {{},
            "This axis cannot home (homing.mode is 0, and no --home was given): effects that depend on position can be "
            "found but not compensated."};
  const CommissionOptions& options = session.options();
  const double way = kSearchOfBox * options.box.travel;
  session.ask(fmt::format(
      "Home: the axis searches for its switch or index within {:g} {} and repeats the voltage steps from there.", way,
      units_of(options.sheet.data.kind).travel));
  session.download(session.with_file(session.folder().require("first-params.toml", "control")));
  session.find_home();
  session.folder().put("homed", true);
  record_steps(session);
  session.disable();
  return {{"steps.csv"}, "The axis is homed: positions count from there, also in all further records."};
}

}  // namespace host
