// While several explanations remain: plans the run that separates them, makes it, and decides.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <numeric>

#include "host/commission/steps.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/model/model_file.hpp"
#include "host/plan/plan_json.hpp"

namespace host {

namespace {

constexpr std::size_t kMostRuns = 3;
constexpr double kLongestRun_s = 15.0;

std::string names(const std::vector<Rival>& rivals) {
  std::string text;
  for (const Rival& rival : rivals) text += (text.empty() ? "" : ", ") + rival_name(rival.kinds);
  return text;
}

/// The verdict after runs that were made to separate explanations.
nlohmann::json decided_verdict(nlohmann::json verdict, const Decision& decision, const std::string& said) {
  std::vector<std::string> kinds;
  for (const std::size_t place : decision.left)
    for (const std::string& kind : decision.rivals[place].kinds)
      if (std::ranges::find(kinds, kind) == kinds.end()) kinds.push_back(kind);
  verdict["effects"] = kinds;
  verdict["explanation"] = said;
  if (decision.left.size() > 1) return verdict;
  verdict["status"] = status_name(Status::missing);
  verdict["alternatives"] = nlohmann::json::array();
  return verdict;
}

class Separation {
 public:
  Separation(CommissionSession& session, sim::DriveDescription model)
      : session_(session), model_(std::move(model)), measured_(read_measurements(session, model_)) {
    all_ = measured_.all_records();
  }

  CommissionStepResult run() {
    find_rivals();
    if (rivals_.size() < 2) return {{}, "Nothing is left to separate."};
    for (std::size_t round = 0; round < kMostRuns && rivals_.size() > 1 && make_one(round);) ++round;
    return {files_, said_};
  }

 private:
  void find_rivals() {
    const Computing computing(session_);
    const nlohmann::json diagnosis = session_.folder().read_json("diagnosis.json");
    const auto effects = diagnosis.at("verdict").at("effects").get<std::vector<std::string>>();
    const auto groups = diagnosis.at("verdict").at("alternatives").get<std::vector<std::vector<std::string>>>();
    const bool is_ambiguous = diagnosis.at("verdict").at("status") == status_name(Status::ambiguous);
    const auto has = [](const std::vector<std::string>& list, const std::string& kind) {
      return std::ranges::find(list, kind) != list.end();
    };
    std::vector<std::vector<std::string>> kinds;
    std::vector<double> believed;
    for (const auto& candidate : diagnosis.at("candidates")) {
      const auto names = candidate.at("kinds").get<std::vector<std::string>>();
      const auto is_open = [&](const auto& group) { return has(group, names.front()); };
      if (!is_ambiguous || names.size() != 1 || !(is_open(effects) || std::ranges::any_of(groups, is_open))) continue;
      kinds.push_back(names);
      believed.push_back(candidate.at("probability"));
    }
    // An effect is certainly missing, and one of the candidates represents others that look alike.
    if (!is_ambiguous && !groups.empty())
      for (const std::string& kind : groups.front()) {
        kinds.push_back({kind});
        believed.push_back(1.0);
        for (const std::string& effect : effects)
          if (!has(groups.front(), effect)) kinds.back().push_back(effect);
      }
    if (kinds.size() < 2) return;
    const Rival known{effects, read_model(session_.folder().require("diagnosed.toml", "diagnose")), 1.0};
    rivals_ = fit_rivals(model_, all_, kinds, {}, is_ambiguous ? nullptr : &known);
    const double sum = std::accumulate(believed.begin(), believed.end(), 0.0);
    for (std::size_t k = 0; k < rivals_.size() && sum > 0.0; ++k) rivals_[k].probability = believed[k] / sum;
  }

  Plan planned(const ExcitationLimits& box) const {
    const Computing computing(session_);
    return plan_run(model_, all_, rivals_, box);
  }

  Decision decided(const Plan& plan, const Record& made) const {
    const Computing computing(session_);
    return decide(plan.rivals, all_, made);
  }

  /// Whether a run was made.
  bool make_one(std::size_t round) {
    CommissionFolder& folder = session_.folder();
    ExcitationLimits box = session_.options().box;
    box.time_s = std::min(kLongestRun_s, box.time_s - session_.motion_s());
    const Plan plan = planned(box);
    const std::string run_file = fmt::format("run-{}.toml", round + 1), record = fmt::format("run-{}.csv", round + 1);
    folder.write_json(fmt::format("plan-{}.json", round + 1), to_json(plan, run_file));
    files_.push_back(fmt::format("plan-{}.json", round + 1));
    if (!plan.by_hand.empty()) said_ += "By hand: " + plan.by_hand + " ";
    if (!plan.separable) return false;
    write_run_plan(plan.run, folder.path(run_file));
    session_.ask(fmt::format("Separate {}: a run of {:.3g} s, with expected odds of {:.2g} to 1 for the true one.",
                             names(rivals_), plan.run.duration_s(), plan.expected_odds));
    session_.download(session_.design(model_, session_.first_loop(model_), "planned-params.toml"));
    Record made = session_.record_plan(plan.run, record);
    files_.insert(files_.end(), {run_file, record});
    folder.put("runs", round + 1);
    decide_by(std::move(made), plan, round);
    return true;
  }

  void decide_by(Record made, const Plan& plan, std::size_t round) {
    CommissionFolder& folder = session_.folder();
    const Decision decision = decided(plan, made);
    runs_.push_back(std::move(made));
    all_.push_back(&runs_.back());
    folder.write_json(fmt::format("decision-{}.json", round + 1), to_json(decision));
    files_.push_back(fmt::format("decision-{}.json", round + 1));
    const Rival& best = decision.rivals[decision.best];
    said_ += fmt::format("A run of {:.3g} s favours {}, {:.3g} to 1 (expected {:.3g} to 1). ", plan.run.duration_s(),
                         rival_name(best.kinds), decision.odds, plan.expected_odds);
    rivals_.clear();
    for (const std::size_t place : decision.left) rivals_.push_back(decision.rivals[place]);
    nlohmann::json diagnosis = folder.read_json("diagnosis.json");
    folder.put("verdict", decided_verdict(diagnosis.at("verdict"), decision, said_));
    if (rivals_.size() > 1) return;
    write_model(best.model, folder.path("decided.toml"));
    files_.emplace_back("decided.toml");
    folder.put("decided", best.kinds);
  }

  CommissionSession& session_;
  sim::DriveDescription model_;
  Measurements measured_;
  std::vector<const Record*> all_;
  std::deque<Record> runs_;
  std::vector<Rival> rivals_;
  std::vector<std::string> files_;
  std::string said_;
};

}  // namespace

CommissionStepResult separate(CommissionSession& session) {
  CommissionFolder& folder = session.folder();
  folder.require("diagnosis.json", "diagnose");
  const nlohmann::json verdict = folder.read_json("diagnosis.json").at("verdict");
  folder.put("verdict", verdict);
  folder.put("decided", nullptr);
  folder.put("runs", 0);
  if (verdict.at("status") != status_name(Status::ambiguous) && verdict.at("alternatives").empty())
    return {{}, "Nothing is left to separate."};
  return Separation(session, read_model(folder.require("model.toml", "friction"))).run();
}

}  // namespace host
