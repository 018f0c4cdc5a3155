// Compares the old and the new parameters by the same motion on the machine; the better set stays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/commission/estimator_choice.hpp"
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
  std::string name, what;             ///< `what`: "with …", for the user
  std::string params, record, again;  ///< file names without the folder
  bool is_tuned = false;              ///< with the estimator that tune_estimator() chose
  firmware::ParameterValues values;
  Compliance compliance;
  std::optional<FollowingError> error, repeated;
  std::string stopped_because;

  bool is_whole() const { return error && repeated; }
  double mean() const { return (error->rms_um + repeated->rms_um) / 2.0; }
  double spread() const { return std::abs(error->rms_um - repeated->rms_um); }
  double best() const { return std::min(error->rms_um, repeated->rms_um); }
  double worst() const { return std::max(error->rms_um, repeated->rms_um); }
  double least_N_um() const { return 1.0 / compliance.um_per_N; }
};

class Comparison {
 public:
  explicit Comparison(CommissionSession& session) : session_(session), folder_(session.folder()) {}

  CommissionStepResult run() {
    const sim::DriveDescription before = read_model(folder_.require("model.toml", "friction"));
    const sim::DriveDescription after = read_model(folder_.require("improved.toml", "improve"));
    session_.ask("Compensate: the same jogs with the old parameters and with the new ones, twice each.");
    const bool was_fitted = folder_.document().value("was_fitted", false);
    const DesignOptions first = session_.first_options(), tuned = session_.tuned_options();
    const bool is_raised = folder_.document().value("raised", nlohmann::json()).is_object();
    const bool is_tuned =
        tuned.disturbance_variance != first.disturbance_variance || tuned.tach_variance != first.tach_variance;
    add("before", "before", was_fitted ? "" : "old-params.toml", false,
        was_fitted ? session_.with_planned_limits(session_.with_file(folder_.require("before-params.toml", "look")))
                   : session_.design(before, session_.first_loop(before), "old-params.toml"));
    if (is_raised || is_tuned) {
      const char* tuned_part = !is_tuned ? "bandwidth" : !is_raised ? "estimator" : "bandwidth and estimator";
      add("loop", fmt::format("with the tuned {} alone", tuned_part), "loop-params.toml", is_tuned,
          session_.design(before, raised_loop(session_, before, tuned), "loop-params.toml"));
    }
    // The estimator was tuned on shorter jogs, so the first one is tried on these as well.
    if (is_tuned)
      add("untuned", "with the better model and the first estimator", "untuned-params.toml", false,
          session_.design(after, raised_loop(session_, after, first), "untuned-params.toml"));
    add("after", "with everything", "new-params.toml", is_tuned,
        session_.design(after, raised_loop(session_, after, tuned), "new-params.toml"));
    // A faster loop also amplifies sensor noise; try the slower loop if that outweighs the gain.
    const auto is_gain = [&](const Trial& trial) {
      return trial.name != "loop" && !is_too_soft(trial) && is_better(trial, trials_.front());
    };
    if (is_raised && std::ranges::none_of(trials_, is_gain))
      add("first-loop", "with the better model and the first loop", "first-loop-params.toml", false,
          session_.design(after, session_.first_loop(after), "first-loop-params.toml"));
    decide(was_fitted);
    return report(after);
  }

 private:
  /// Whether every run of `one` deviates less than every run of `other`, by more than the repeatability.
  bool is_better(const Trial& one, const Trial& other) const {
    if (!one.is_whole() || !other.is_whole()) return one.is_whole();
    const std::optional<double> force_N = session_.options().force_N;
    return deviation_um(other.best(), other.compliance, force_N) - deviation_um(one.worst(), one.compliance, force_N) >
           std::max(one.spread(), other.spread());
  }

  /// Whether the tuned estimator makes the axis softer than the first one does. Not checked if a process force is
  /// given: that decides.
  bool is_too_soft(const Trial& trial) const {
    const auto untuned = std::ranges::find(trials_, "untuned", &Trial::name);
    return trial.is_tuned && !session_.options().force_N && untuned != trials_.end() &&
           is_softer(trial.compliance, untuned->compliance);
  }

  void add(const std::string& name, const std::string& what, const std::string& params, bool is_tuned,
           firmware::ParameterValues values) {
    trials_.push_back(
        {name, what, params, name + ".csv", name + "-again.csv", is_tuned, std::move(values), {}, {}, {}, {}});
    Trial& trial = trials_.back();
    trial.compliance = compliance_with(session_, read_model(folder_.require("improved.toml", "improve")),
                                       firmware::axis_parameters<float>(trial.values.axis(session_.options().axis)));
    session_.download(trial.values);
    trial.error = tried(trial, trial.record);
    if (trial.error) trial.repeated = tried(trial, trial.again);
  }

  /// Runs the trial; empty if the axis stopped with a fault. The old parameters are then kept.
  std::optional<FollowingError> tried(Trial& trial, const std::string& file) {
    const CommissionRun jogs = judging_jogs(session_, file);
    const auto run = trials_.size() == 1 ? session_.record(jogs) : session_.try_record(jogs, trial.stopped_because);
    if (!run) return std::nullopt;
    return following_error(*run, session_.options().sheet.data);
  }

  const Trial& before() const { return trials_.front(); }
  const Trial& kept() const { return trials_[kept_]; }
  bool is_new() const { return kept_ > 0; }
  /// The kept set; if it is the old one, the last that was tried.
  const Trial& after() const { return is_new() ? kept() : trials_.back(); }

  /// Selects the set that stays on the board: the best of the permitted ones, by is_better().
  void decide(bool was_fitted) {
    for (std::size_t i = 0; i < trials_.size(); ++i)
      if (!is_too_soft(trials_[i]) && is_better(trials_[i], kept())) kept_ = i;
    session_.download(!is_new() && was_fitted ? session_.with_file(folder_.path("before-params.toml")) : kept().values);
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
                      {"what", trial.what},
                      {"rms_um", trial.is_whole() ? nlohmann::json(trial.mean()) : nlohmann::json()},
                      {"largest_um", trial.error ? nlohmann::json(trial.error->largest_um) : nlohmann::json()},
                      {"repeats_um", trial.is_whole() ? nlohmann::json(trial.spread()) : nlohmann::json()},
                      {"compliance_um_N", trial.compliance.um_per_N},
                      {"too_soft", is_too_soft(trial)},
                      {"record", trial.record},
                      {"stopped_because", trial.stopped_because}});
      for (const std::string& file : {trial.params, trial.record, trial.again})
        if (!file.empty() && folder_.has(file)) files.push_back(file);
    }
    std::vector<std::string> by_hand = uncompensated_effects(model), unhomed;
    if (!folder_.document().value("homed", false))
      for (const char* kind : {"cogging", "position_dependent_friction"})
        if (model.find(kind) != nullptr) unhomed.emplace_back(kind);
    folder_.write_json("errors.json", {{"sets", sets},
                                       {"kept", kept().name},
                                       {"floor_um", floor_um_},
                                       {"by_hand", by_hand},
                                       {"needs_home", unhomed}});
    files.emplace_back("errors.json");
    folder_.put("following_error_um",
                {{"before", before().mean()},
                 {"after", after().is_whole() ? nlohmann::json(after().mean()) : nlohmann::json()},
                 {"floor", floor_um_}});
    folder_.put("kept", is_new() ? "new" : "old");
    folder_.put("estimator_kept", kept().is_tuned);
    folder_.put("saved", session_.options().save);
    return {files, sentence()};
  }

  std::string sentence() const {
    std::string said = fmt::format("Following error {:.3g} µm RMS before", before().mean());
    for (const Trial& trial : trials_) {
      if (&trial == &before()) continue;
      said += trial.is_whole() ? fmt::format(", {:.3g} {}", trial.mean(), trial.what)
                               : fmt::format(", and {} the axis stopped: {}", trial.what, trial.stopped_because);
    }
    said += is_new() ? "." : ": no permitted set improves on it by more than equal runs differ.";
    said += fmt::format(" Least stiffness against a process force: {:.3g} N/µm before", before().least_N_um());
    if (is_new()) said += fmt::format(", {:.3g} now", kept().least_N_um());
    said += ".";
    for (const Trial& trial : trials_)
      if (is_too_soft(trial))
        said += fmt::format(" The set {} is not permitted: its estimator makes the axis softer, {:.3g} N/µm.",
                            trial.what, trial.least_N_um());
    return said + fmt::format(" The {} is on the board{}.", is_new() ? "set " + kept().what : "old set",
                              session_.options().save ? ", and saved"
                                                      : " and not saved: `axistool save` keeps it after power-off");
  }

  CommissionSession& session_;
  CommissionFolder& folder_;
  std::vector<Trial> trials_;
  std::size_t kept_ = 0;  ///< place in trials_
  double floor_um_ = 0.0;
};

}  // namespace

CommissionStepResult compensate(CommissionSession& session) { return Comparison(session).run(); }

}  // namespace host
