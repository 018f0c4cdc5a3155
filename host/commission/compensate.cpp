// The same motion with the old and with the new parameters, on the machine; the better set stays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/atomic_file.hpp"
#include "host/commission/following.hpp"
#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

nlohmann::json error_json(const FollowingError& error) {
  return {{"rms_um", error.rms_um}, {"largest_um", error.largest_um}};
}

/// What the machine does with the new parameters; nothing where they made it stop.
std::optional<FollowingError> try_new(CommissionSession& session, std::string& why) {
  try {
    return following_error(session.record(judging_jogs(session, "after.csv")), session.options().sheet.data);
  } catch (const Failure& failure) {
    if (session.talk().stop() || failure.code != ExitCode::device_fault) throw;
    why = failure.what();
    session.disable();
    session.board().clear_faults();
    session.board().wait(std::chrono::milliseconds(300));  // the self-test that follows
    return std::nullopt;
  }
}

}  // namespace

CommissionStepResult compensate(CommissionSession& session) {
  CommissionFolder& folder = session.folder();
  const sim::DriveDescription before = read_model(folder.require("model.toml", "friction"));
  const sim::DriveDescription after = read_model(folder.require("improved.toml", "improve"));
  session.ask("Compensate: the same jogs with the old parameters and with the new ones.");
  const bool was_fitted = folder.document().value("was_fitted", false);
  const firmware::ParameterValues old_set =
      was_fitted ? session.with_planned_limits(session.with_file(folder.require("before-params.toml", "look")))
                 : session.design(before, "old-params.toml");
  session.download(old_set);
  const FollowingError old_error =
      following_error(session.record(judging_jogs(session, "before.csv")), session.options().sheet.data);
  session.download(session.design(after, "new-params.toml"));
  std::string why;
  const std::optional<FollowingError> new_error = try_new(session, why);
  const bool is_better = new_error && new_error->rms_um < old_error.rms_um;
  if (!is_better) session.download(was_fitted ? session.with_file(folder.path("before-params.toml")) : old_set);
  session.disable();
  if (session.options().save) session.board().save();
  const double floor = following_floor_um(read_record(folder.require("judge-jogs.csv", "validate")),
                                          read_record(folder.require("judge-again.csv", "validate")));
  folder.write_json("errors.json", {{"before", error_json(old_error)},
                                    {"after", new_error ? error_json(*new_error) : nlohmann::json()},
                                    {"floor_um", floor},
                                    {"by_hand", uncompensated_effects(after)}});
  folder.put("following_error_um", {{"before", old_error.rms_um},
                                    {"after", new_error ? nlohmann::json(new_error->rms_um) : nlohmann::json()},
                                    {"floor", floor}});
  folder.put("kept", is_better ? "new" : "old");
  folder.put("saved", session.options().save);
  std::string said = new_error
                         ? fmt::format("Following error {:.3g} → {:.3g} µm RMS.", old_error.rms_um, new_error->rms_um)
                         : "With the new parameters the axis stopped: " + why + ".";
  said += fmt::format(" The {} set is on the board{}.", is_better ? "new" : "old",
                      session.options().save ? ", and saved" : " and not saved: `axistool save` makes it last");
  std::vector<std::string> files{"new-params.toml", "before.csv", "after.csv", "errors.json"};
  if (!was_fitted) files.insert(files.begin(), "old-params.toml");
  return {files, said};
}

}  // namespace host
