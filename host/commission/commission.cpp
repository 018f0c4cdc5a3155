#include "host/commission/commission.hpp"

#include <fmt/format.h>

#include <array>

#include "firmware/core/axis_fault.hpp"
#include "host/cancellation.hpp"
#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr std::array<CommissionStepResult (*)(CommissionSession&), kCommissionSteps.size()> kWork{
    look,          identify_first,   control_first,     home_axis,     climb_ladder,
    find_friction, measure_response, record_validation, compare_first, diagnose_machine,
    separate,      improve_model,    tune_estimator,    compensate,    write_page};

/// Restores the former parameters of a board; ignores errors, because a step has already failed.
void give_back(CommissionSession& session) noexcept {
  session.leave_standing();
  try {
    if (session.folder().document().value("was_fitted", false) && session.folder().has("before-params.toml"))
      session.download(session.with_file(session.folder().path("before-params.toml")));
  } catch (const std::exception&) {  // the board has gone; its flash still holds what was saved
  }
}

constexpr std::size_t kControl = 2, kLastInLoop = 7;  // places of control, validate
static_assert(kCommissionSteps[kControl].name == "control" && kCommissionSteps[kLastInLoop].name == "validate");

/// A step that moves with the first controller.
bool is_in_loop(std::size_t step) { return step > kControl && step <= kLastInLoop; }

/// The axis has stopped with a fault that too high a bandwidth may have caused.
bool is_swinging(CommissionSession& session) {
  const auto fault = static_cast<firmware::AxisFault>(session.board().status().axis.at(session.options().axis).fault);
  return fault == firmware::AxisFault::limit_cycle || fault == firmware::AxisFault::following_error ||
         fault == firmware::AxisFault::saturation_too_long;
}

}  // namespace

void commission_axis(BoardClient& board, const CommissionOptions& options, const CommissionTalk& talk,
                     CommissionFolder& folder, std::size_t from, std::size_t to) {
  board.require_same_table();
  folder.begin_at(from);
  if (from <= kControl) folder.put("halvings", 0);
  if (from == 0) folder.put("motion_s", 0.0);
  CommissionSession session(board, options, talk, folder);
  if (from > 0) session.give_scales();
  for (std::size_t step = from; step <= to; ++step) {
    talk.tell(fmt::format("{}: {}", kCommissionSteps[step].name, kCommissionSteps[step].does));
    try {
      const CommissionStepResult result = kWork[step](session);
      folder.finish(step, result.files, result.said);
      talk.tell("  " + result.said);
    } catch (const Cancelled&) {
      give_back(session);
      throw;
    } catch (const Failure& failure) {
      if (failure.code == ExitCode::device_fault && is_swinging(session) && is_in_loop(step) && session.calm_down()) {
        talk.tell(fmt::format("  The loop oscillates: {}. Trying again with half the bandwidth.", failure.what()));
        step = kControl - 1;
        continue;
      }
      give_back(session);
      const std::string how = fmt::format(
          "{}. The axis is at rest and disabled; {} steps are in the folder. After correcting this, continue with "
          "--from {}",
          failure.what(), step, kCommissionSteps[step].name);
      try {
        folder.put("stopped_because", failure.what());
      } catch (const Failure&) {  // the cause may be the disk
      }
      throw Failure(failure.code, fmt::format("{}: {}", kCommissionSteps[step].name, how));
    }
  }
  session.leave_standing();
}

}  // namespace host
