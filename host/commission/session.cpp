#include "host/commission/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/atomic_file.hpp"
#include "host/device/excitation_end.hpp"
#include "host/device/motion.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/friction_law.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/parameters/data_sheet_values.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/parameters/parameter_names.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

constexpr double kRideMargin =
    1.3;  // box's speed, which the board enforces, relative to a commanded speed (excite requires 1.25)

/// An axis without current coasts for a moment, and the board enables only an axis at rest.
constexpr std::chrono::milliseconds kToRest{500};

}  // namespace

CommissionSession::CommissionSession(BoardClient& board, CommissionOptions options, CommissionTalk talk,
                                     CommissionFolder& folder)
    : board_(board), options_(std::move(options)), talk_(std::move(talk)), folder_(folder), origin_(counts()) {
  motion_s_ = folder.document().value("motion_s", 0.0);
}

std::int64_t CommissionSession::counts() { return board_.status().axis.at(options_.axis).counts(); }

double CommissionSession::steady_speed() const {
  // A second of motion, with its acceleration and deceleration, must fit the travel.
  return std::min(options_.box.speed / kRideMargin, 0.6 * options_.box.travel);
}

double CommissionSession::top_speed() const {
  // A stop may take a quarter of the travel (excitation_design.cpp), with a reserve for its jerk.
  const double acceleration = folder_.document().at("limits").at("acceleration");
  return std::min(options_.box.speed / kRideMargin, 0.8 * std::sqrt(acceleration * options_.box.travel / 2.0));
}

void CommissionSession::ask(const std::string& what) {
  const ExcitationLimits& box = options_.box;
  const char* unit = units_of(options_.sheet.data.kind).travel;
  const std::string question = fmt::format(
      "{} Axis {} moves at most {:g} {} from its initial position in each direction, {:g} {}/s, {:g} V; {:.0f} s of "
      "{:g} s of motion remain. Continue?",
      what, options_.axis_name, box.travel / 2.0, unit, box.speed, unit, box.volts, box.time_s - motion_s_, box.time_s);
  if (!talk_.consents(question)) throw Failure(ExitCode::refused, "not done, as you wished: " + what);
}

ExcitationScale CommissionSession::scale(const firmware::ParameterValues& values) const {
  const sim::DataSheet& sheet = options_.sheet.data;
  ExcitationScale scale = excitation_scale(values, options_.axis, sheet.kind);
  scale.encoder_resolution = sheet.encoder_resolution;
  scale.dac_resolution_V = sheet.dac_resolution_V;
  scale.lead = sheet.lead;
  scale.table_resolution = sheet.load_encoder_resolution;
  return scale;
}

void CommissionSession::spend(std::chrono::steady_clock::time_point begin) {
  motion_s_ += std::chrono::duration<double>(board_.now() - begin).count();
  folder_.put("motion_s", motion_s_);
}

void CommissionSession::go_back() {
  const std::int64_t away = counts() - origin_;
  if (away == 0) return;
  move_and_wait(board_, options_.axis, -away, true, talk_.stop);
  if (talk_.stop()) throw Failure(ExitCode::refused, "interrupted");
}

void CommissionSession::enable() {
  const auto state = static_cast<firmware::SupervisorState>(board_.status().axis.at(options_.axis).state);
  if (state == firmware::SupervisorState::enabled) return;
  board_.wait(kToRest);
  enable_and_wait(board_, mask());
}

ExcitationLimits CommissionSession::room_for(double time_s, const std::string& what,
                                             const firmware::ParameterValues& values) {
  ExcitationLimits box = options_.box;
  box.time_s = time_s;
  if (motion_s_ + time_s > options_.box.time_s)
    throw Failure(ExitCode::refused, fmt::format("{} would take {:g} s, but of the box's {:g} s only {:.0f} remain: "
                                                 "give a longer --box time=… to continue from here",
                                                 what, time_s, options_.box.time_s, options_.box.time_s - motion_s_));
  if (values.axis(options_.axis).get<"drive.fitted">()) {
    enable();
    if (folder_.document().value("homed", false) && !is_homed())
      find_home();  // a reset and some faults clear the homing
    go_back();
  }
  const double away = static_cast<double>(std::abs(counts() - origin_)) * options_.sheet.data.encoder_resolution;
  box.travel -= 2.0 * away;
  if (box.travel < options_.box.travel / 4.0)
    throw Failure(ExitCode::refused, fmt::format("the axis is {:g} from its initial position, near the end of the box: "
                                                 "move it back by hand, or widen travel",
                                                 away));
  return box;
}

Record CommissionSession::keep(const ExcitationOutcome& outcome, const std::map<std::string, std::string>& header,
                               const std::string& file) {
  Record record = capture_record(outcome.capture, outcome.settings, options_.axis_name);
  record.header["source"] = "axistool commission";
  record.header.insert(header.begin(), header.end());
  record.header["excitation_ended"] = std::string(end_name(outcome.state));
  write_record(record, folder_.path(file));
  require_completed(board_, options_.axis, outcome, folder_.path(file) + " holds the rows so far");
  record.path = folder_.path(file);
  return record;
}

Record CommissionSession::record(const CommissionRun& run) {
  const auto begin = board_.now();
  const firmware::ParameterValues values = board_.read_values();
  const ExcitationScale units = scale(values);
  const ExcitationLimits box = room_for(run.time_s, run.file, values);
  const Excitation excitation = design_excitation(run.kind, run.numbers, box, units, run.loop);
  if (excitation.request.input == static_cast<std::uint8_t>(firmware::ExcitationInput::open_loop)) disable();
  const ExcitationOutcome outcome = run_excitation(board_, options_.axis, excitation, values, units, talk_.stop);
  spend(begin);
  return keep(outcome, excitation.header, run.file);
}

std::optional<Record> CommissionSession::try_record(const CommissionRun& run, std::string& stopped_because) {
  try {
    return record(run);
  } catch (const Failure& failure) {
    if (talk_.stop() || failure.code != ExitCode::device_fault) throw;
    stopped_because = failure.what();
    recover();
    return std::nullopt;
  }
}

Record CommissionSession::record_plan(const RunPlan& run, const std::string& file) {
  const auto begin = board_.now();
  const firmware::ParameterValues values = board_.read_values();
  const ExcitationScale units = scale(values);
  const ExcitationLimits box = within_both(run.box, room_for(run.duration_s(), file, values));
  disable();
  board_.wait(kToRest);
  const ExcitationOutcome outcome = run_excitations(
      board_, options_.axis, run.pieces.size(),
      [&](std::size_t piece, double offset) {
        ExcitationLimits whole = box;
        whole.time_s = run.box.time_s;
        return design_piece(run.pieces[piece], whole, offset, units);
      },
      values, units, talk_.stop);
  spend(begin);
  return keep(outcome, run_header(run), file);
}

firmware::ParameterValues CommissionSession::with_file(const std::string& path) {
  firmware::ParameterValues values = board_.read_values();
  put_file(values, path, options_.axis_name);
  return values;
}

void CommissionSession::download(const firmware::ParameterValues& values) {
  require_fitting_set(values);
  if (values == board_.read_values()) return;
  disable();
  board_.write_values(values);
}

void CommissionSession::plan_limits(const sim::DriveDescription& model) {
  const AxisDesign made = design_axis(model, {});
  const FrictionLaw friction = friction_law(model);
  const double dry = std::max(friction.effort(1e-3 * options_.box.speed), -friction.effort(-1e-3 * options_.box.speed));
  // Half of the box's volts beyond friction; the other half is for the feedback.
  const double available =
      0.5 * model.data.lead * (made.axis.effort_per_volt * options_.box.volts - dry) / made.axis.inertia;
  if (!(available > 0.0))
    throw Failure(ExitCode::refused, "friction needs all of the box's volts: none remain for acceleration");
  const ReferenceLimits usual = ReferenceLimits::usual_for(model.data.kind);
  const double acceleration = std::min(usual.acceleration, available);
  folder_.put("feedback_V", available * made.axis.inertia / (model.data.lead * made.axis.effort_per_volt));
  folder_.put("limits", {{"velocity", std::min(usual.velocity, options_.box.speed / kRideMargin)},
                         {"acceleration", acceleration},
                         {"jerk", acceleration * usual.jerk / usual.acceleration}});
}

ReferenceLimits CommissionSession::limits() const {
  const nlohmann::json& planned = folder_.document().at("limits");
  return {planned.at("velocity"), planned.at("acceleration"), planned.at("jerk")};
}

firmware::ParameterValues CommissionSession::with_planned_limits(firmware::ParameterValues values) const {
  for (const auto& [name, value] : folder_.document().at("limits").items())
    values.set(require_place(fmt::format("{}.limits.{}", options_.axis_name, name)), value.get<float>());
  return values;
}

DesignOptions CommissionSession::first_options() const {
  DesignOptions wanted;
  const int halvings = folder_.document().value("halvings", 0);
  wanted.bandwidth_Hz = std::ldexp(options_.bandwidth_Hz, -halvings);
  wanted.disturbance_variance = std::ldexp(wanted.disturbance_variance, -4 * halvings);
  return wanted;
}

DesignOptions CommissionSession::tuned_options() const {
  DesignOptions wanted = first_options();
  const nlohmann::json estimator = folder_.document().value("estimator", nlohmann::json());
  if (!estimator.is_object()) return wanted;
  wanted.disturbance_variance = estimator.at("rwd_V2");
  if (estimator.at("rw").is_number()) wanted.tach_variance = estimator.at("rw").get<double>();
  return wanted;
}

DesignOptions CommissionSession::kept_options() const {
  return folder_.document().value("estimator_kept", false) ? tuned_options() : first_options();
}

CommissionLoop CommissionSession::first_loop(const sim::DriveDescription& model) const {
  return {design_axis(model, first_options()), {}};
}

firmware::ParameterValues CommissionSession::design(const sim::DriveDescription& model, const CommissionLoop& loop,
                                                    const std::string& file) {
  const std::string text = board_parameters_toml(model, loop.design, limits()) + compensation_toml(model) +
                           filter_toml(model, loop.filters) + parameter_tables(model, homing_parameters());
  firmware::ParameterValues values = board_.read_values();
  for (const Assignment& one : parse_parameter_text(text, file, options_.axis_name)) put(values, one);
  require_fitting_set(values);
  write_file_atomically(folder_.path(file), text);
  return values;
}

void CommissionSession::recover() {
  disable();
  board_.clear_faults();
  board_.wait(kToRest);  // a self-test follows
}

bool CommissionSession::calm_down() {
  constexpr int kMost = 3;
  const int halvings = folder_.document().value("halvings", 0);
  if (halvings == kMost) return false;
  recover();
  folder_.put("halvings", halvings + 1);
  return true;
}

void CommissionSession::give_scales() {
  const sim::DataSheet& sheet = options_.sheet.data;
  const std::uint8_t axis = options_.axis;
  const firmware::ParameterValues before = board_.read_values();
  firmware::ParameterValues values = with_data_sheet(before, axis, sheet);
  if (before.axis(axis).get<"drive.fitted">()) {
    for (const char* name : {"drive.lead", "drive.encoder_resolution", "drive.dac_resolution"}) {
      const std::size_t place = require_place(options_.axis_name + "." + name);
      if (std::abs(values.at(place) - before.at(place)) > 1e-5F * std::abs(before.at(place)))
        throw Failure(ExitCode::refused,
                      fmt::format("{} is {} on the board and {} in the data sheet: correct the wrong one first",
                                  full_name(place), before.at(place), values.at(place)));
    }
    return;
  }
  values.set(require_place("control.rate"), static_cast<float>(std::round(1.0 / sheet.sample_period_s)));
  download(values);
}

void CommissionSession::disable() {
  const auto state = static_cast<firmware::SupervisorState>(board_.status().axis.at(options_.axis).state);
  if (firmware::outputs_are_on(state)) disable_and_wait(board_, mask());
}

void CommissionSession::leave_standing() noexcept {
  try {
    board_.stop_excitation();
  } catch (const std::exception&) {  // no motion ran, or the board is gone
  }
  try {
    disable();
  } catch (const std::exception&) {  // the board is gone: its heartbeat time-out stops the axis
  }
}

}  // namespace host
