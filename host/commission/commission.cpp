#include "host/commission/commission.hpp"

#include <fmt/format.h>

#include <array>

#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr std::array<CommissionStepResult (*)(CommissionSession&), kCommissionSteps.size()> kWork{
    look,          identify_first,   control_first, climb_ladder, find_friction, measure_response, record_validation,
    compare_first, diagnose_machine, improve_model, compensate,   write_page};

/// Gives a board that was fitted before its own parameters back; quietly, since something has failed already.
void give_back(CommissionSession& session) noexcept {
  session.leave_standing();
  try {
    if (session.folder().document().value("was_fitted", false) && session.folder().has("before-params.toml"))
      session.download(session.with_file(session.folder().path("before-params.toml")));
  } catch (const std::exception&) {  // the board has gone; its flash still holds what was saved
  }
}

}  // namespace

void commission_axis(BoardClient& board, const CommissionOptions& options, const CommissionTalk& talk,
                     CommissionFolder& folder, std::size_t from, std::size_t to) {
  board.require_same_table();
  folder.begin_at(from);
  CommissionSession session(board, options, talk, folder);
  if (from > 0) session.give_scales();
  for (std::size_t step = from; step <= to; ++step) {
    talk.tell(fmt::format("{}: {}", kCommissionSteps[step].name, kCommissionSteps[step].does));
    try {
      const CommissionStepResult result = kWork[step](session);
      folder.finish(step, result.files, result.said);
      talk.tell("  " + result.said);
    } catch (const Failure& failure) {
      give_back(session);
      const std::string how = fmt::format(
          "{}. The axis stands, disabled; {} steps are in the folder. When that is mended, "
          "go on with --from {}",
          failure.what(), step, kCommissionSteps[step].name);
      try {
        folder.put("stopped_because", failure.what());
      } catch (const Failure&) {  // what ended it may be the disk
      }
      throw Failure(failure.code, fmt::format("{}: {}", kCommissionSteps[step].name, how));
    }
  }
  session.leave_standing();
}

}  // namespace host
