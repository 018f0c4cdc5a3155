#include "host/commission/matched_loops.hpp"

#include <fmt/format.h>

#include <deque>

#include "host/axes/machine_design.hpp"
#include "host/commission/following.hpp"
#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/response/axis_response.hpp"

namespace host {

namespace {

AxisTask task_of(const CommissionedAxis& axis) {
  AxisTask task{read_model(axis.folder->require("improved.toml", "improve")), {}};
  task.model.name = axis.options.axis_name;
  if (!axis.folder->has("response.json")) return task;
  task.measured = read_response(axis.folder->path("response.json"));
  if (!task.measured->fit) task.measured.reset();
  return task;
}

/// Following error with the parameters that commissioning left on the board, µm RMS.
double own_error_um(const CommissionFolder& folder) {
  const nlohmann::json errors = folder.read_json("errors.json");
  for (const nlohmann::json& set : errors.at("sets"))
    if (set.at("name") == errors.at("kept")) return set.at("rms_um");
  throw Failure(ExitCode::bad_input,
                folder.path("errors.json") + ": lacks the set of parameters that it names as kept");
}

std::string poles_of(const LoopSet& loops) {
  std::string text;
  for (const AxisLoop& loop : loops.axes)
    text += fmt::format("{}{:.3g} Hz ({})", text.empty() ? "" : ", ", loop.design.used.bandwidth_Hz, loop.model.name);
  return text;
}

void tell_design(const MachineDesign& machine, const CommissionTalk& talk) {
  talk.tell(fmt::format("  Poles at {:.3g} Hz for all axes; own loops: {}. Limited by {}.",
                        machine.matched.axes.front().design.used.bandwidth_Hz, poles_of(machine.own),
                        machine.limited_by));
  const FeedContour &matched = machine.matched.contour.back(), &own = machine.own.contour.back();
  talk.tell(
      fmt::format("  Expected from the mismatch of the axes at {:g} mm/s: {:.3g} µm on a line at 45° (own loops "
                  "{:.3g} µm), half axes of a circle differ by {:.3g} µm ({:.3g} µm).",
                  matched.feed_mm_s, matched.line_45_um, own.line_45_um, matched.ellipse_um, own.ellipse_um));
}

/// Disables the axes and restores the parameters; false if the board has gone.
bool give_back(std::deque<CommissionSession>& sessions, const firmware::ParameterValues& before) noexcept {
  try {
    for (CommissionSession& session : sessions) session.leave_standing();
    for (CommissionSession& session : sessions) session.recover();
    sessions.front().download(before);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

nlohmann::json match_loops(BoardClient& board, const std::vector<CommissionedAxis>& axes, const CommissionTalk& talk) {
  talk.tell("match: one closed loop for all axes, so that straight lines stay straight");
  std::vector<AxisTask> tasks;
  std::deque<CommissionSession> sessions;
  DesignOptions options;
  LoopAim aim;
  aim.seek_notch = true;
  for (const CommissionedAxis& axis : axes) {
    tasks.push_back(task_of(axis));
    sessions.emplace_back(board, axis.options, talk, *axis.folder);
    const DesignOptions own = sessions.back().kept_options();
    if (sessions.size() == 1 || own.bandwidth_Hz < options.bandwidth_Hz) options.bandwidth_Hz = own.bandwidth_Hz;
    tasks.back().disturbance_variance = own.disturbance_variance;
    tasks.back().tach_variance = own.tach_variance;
    aim.modulus = axis.options.modulus;
  }
  const MachineDesign machine = [&] {
    const Computing computing(sessions.front());
    return design_machine(tasks, options, aim);
  }();
  tell_design(machine, talk);
  nlohmann::json document = machine_json(machine);
  const firmware::ParameterValues before = board.read_values();
  try {
    for (std::size_t i = 0; i < sessions.size(); ++i) {
      sessions[i].ask("Match: the same jogs with the loop of all axes.");
      const AxisLoop& loop = machine.matched.axes[i];
      sessions[i].download(sessions[i].design(loop.model, {loop.design, loop.filters}, "matched-params.toml"));
    }
    for (std::size_t i = 0; i < sessions.size(); ++i) {
      const std::string& axis = axes[i].options.axis_name;
      const Record record = sessions[i].record(judging_jogs(sessions[i], "matched.csv"));
      const double error_um = following_error(record, axes[i].options.sheet.data).rms_um;
      const double own_um = own_error_um(*axes[i].folder);
      document["following_error_um"][axis] = {{"own", own_um}, {"matched", error_um}};
      talk.tell(
          fmt::format("  Axis {} follows within {:.3g} µm RMS; with its own loop {:.3g} µm.", axis, error_um, own_um));
      sessions[i].disable();
    }
    if (axes.front().options.save) board.save();
  } catch (const Failure& failure) {
    throw Failure(failure.code, fmt::format("match: {}. {}", failure.what(),
                                            give_back(sessions, before)
                                                ? "The axes are disabled and have their own loops again"
                                                : "The board does not answer: its loops are unknown until it does"));
  }
  return document;
}

}  // namespace host
