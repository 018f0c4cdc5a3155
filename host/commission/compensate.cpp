// Compares the old and the new parameters by the same motion on the machine; the better set stays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/commission/following.hpp"
#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

/// A set of parameters and the machine's two runs with it.
struct Trial {
  std::string name, params, record, again;  ///< file names without the folder
  firmware::ParameterValues values;
  std::optional<FollowingError> error, repeated;
  std::string stopped_because;

  bool is_whole() const { return error && repeated; }
  double mean() const { return (error->rms_um + repeated->rms_um) / 2.0; }
  double spread() const { return std::abs(error->rms_um - repeated->rms_um); }
  double best() const { return std::min(error->rms_um, repeated->rms_um); }
  double worst() const { return std::max(error->rms_um, repeated->rms_um); }
};

/// Whether every run of `one` is better than every run of `other` by more than the repeatability.
bool is_better(const Trial& one, const Trial& other) {
  if (!one.is_whole() || !other.is_whole()) return one.is_whole();
  return other.best() - one.worst() > std::max(one.spread(), other.spread());
}

class Comparison {
 public:
  explicit Comparison(CommissionSession& session) : session_(session), folder_(session.folder()) {}

  CommissionStepResult run() {
    const sim::DriveDescription before = read_model(folder_.require("model.toml", "friction"));
    const sim::DriveDescription after = read_model(folder_.require("improved.toml", "improve"));
    session_.ask("Compensate: the same jogs with the old parameters and with the new ones, twice each.");
    const bool was_fitted = folder_.document().value("was_fitted", false);
    const bool is_raised = folder_.document().value("raised", nlohmann::json()).is_object();
    add("before", was_fitted ? "" : "old-params.toml",
        was_fitted ? session_.with_planned_limits(session_.with_file(folder_.require("before-params.toml", "look")))
                   : session_.design(before, session_.first_loop(before), "old-params.toml"));
    if (is_raised)
      add("bandwidth", "bandwidth-params.toml",
          session_.design(before, raised_loop(session_, before), "bandwidth-params.toml"));
    add("after", "new-params.toml", session_.design(after, raised_loop(session_, after), "new-params.toml"));
    // A higher bandwidth also amplifies sensor noise; reject the set if that outweighs the gain.
    if (is_raised && !is_better(trials_.back(), trials_.front()))
      add("after", "new-params.toml", session_.design(after, session_.first_loop(after), "new-params.toml"));
    decide(was_fitted);
    return report(after);
  }

 private:
  void add(const std::string& name, const std::string& params, firmware::ParameterValues values) {
    std::erase_if(trials_, [&](const Trial& trial) { return trial.name == name; });
    trials_.push_back({name, params, name + ".csv", name + "-again.csv", std::move(values), {}, {}, {}});
    Trial& trial = trials_.back();
    session_.download(trial.values);
    trial.error = tried(trial, trial.record);
    if (trial.error) trial.repeated = tried(trial, trial.again);
  }

  /// Runs the trial; empty if the axis stopped with a fault. The old parameters are then kept.
  std::optional<FollowingError> tried(Trial& trial, const std::string& file) {
    try {
      return following_error(session_.record(judging_jogs(session_, file)), session_.options().sheet.data);
    } catch (const Failure& failure) {
      if (session_.talk().stop() || failure.code != ExitCode::device_fault || trials_.size() == 1) throw;
      trial.stopped_because = failure.what();
      session_.recover();
      return std::nullopt;
    }
  }

  const Trial& before() const { return trials_.front(); }
  const Trial& after() const { return trials_.back(); }

  /// Selects the set that stays on the board.
  void decide(bool was_fitted) {
    const Trial* best = &trials_.front();
    for (const Trial& trial : trials_)
      if (is_better(trial, *best)) best = &trial;
    is_new_ = best != &trials_.front();
    kept_ = best->name;
    session_.download(!is_new_ && was_fitted ? session_.with_file(folder_.path("before-params.toml")) : best->values);
    session_.disable();
    if (session_.options().save) session_.board().save();
    const Trial& last = after().is_whole() ? after() : before();
    floor_um_ = following_floor_um(read_record(folder_.path(last.record)), read_record(folder_.path(last.again)));
  }

  CommissionStepResult report(const sim::DriveDescription& model) {
    nlohmann::json sets = nlohmann::json::array();
    std::vector<std::string> files;
    for (const Trial& trial : trials_) {
      sets.push_back({{"name", trial.name},
                      {"rms_um", trial.is_whole() ? nlohmann::json(trial.mean()) : nlohmann::json()},
                      {"largest_um", trial.error ? nlohmann::json(trial.error->largest_um) : nlohmann::json()},
                      {"repeats_um", trial.is_whole() ? nlohmann::json(trial.spread()) : nlohmann::json()},
                      {"record", trial.record},
                      {"stopped_because", trial.stopped_because}});
      for (const std::string& file : {trial.params, trial.record, trial.again})
        if (!file.empty() && folder_.has(file)) files.push_back(file);
    }
    std::vector<std::string> by_hand = uncompensated_effects(model), unhomed;
    if (!folder_.document().value("homed", false))
      for (const char* kind : {"cogging", "position_dependent_friction"})
        if (model.find(kind) != nullptr) unhomed.emplace_back(kind);
    folder_.write_json(
        "errors.json",
        {{"sets", sets}, {"kept", kept_}, {"floor_um", floor_um_}, {"by_hand", by_hand}, {"needs_home", unhomed}});
    files.emplace_back("errors.json");
    folder_.put("following_error_um",
                {{"before", before().mean()},
                 {"after", after().is_whole() ? nlohmann::json(after().mean()) : nlohmann::json()},
                 {"floor", floor_um_}});
    folder_.put("kept", is_new_ ? "new" : "old");
    folder_.put("saved", session_.options().save);
    return {files, sentence()};
  }

  std::string sentence() const {
    std::string said = fmt::format("Following error {:.3g} µm RMS before", before().mean());
    for (const Trial& trial : trials_) {
      if (&trial == &before()) continue;
      const char* what = trial.name == "bandwidth" ? "with the bandwidth alone" : "with everything";
      said += trial.is_whole() ? fmt::format(", {:.3g} {}", trial.mean(), what)
                               : fmt::format(", and {} the axis stopped: {}", what, trial.stopped_because);
    }
    said += is_new_ ? "." : ": no gain beyond the difference between equal runs.";
    return said + fmt::format(" The {} set is on the board{}.", is_new_ ? "new" : "old",
                              session_.options().save ? ", and saved"
                                                      : " and not saved: `axistool save` keeps it after power-off");
  }

  CommissionSession& session_;
  CommissionFolder& folder_;
  std::vector<Trial> trials_;
  bool is_new_ = false;
  std::string kept_;
  double floor_um_ = 0.0;
};

}  // namespace

CommissionStepResult compensate(CommissionSession& session) { return Comparison(session).run(); }

}  // namespace host
