#include "host/scoreboard/scoreboard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace host {

namespace {

/// A case whose whole data have an error above this many noise floors has an effect to find, even if its pieces show
/// less.
constexpr double kSomethingToFind = 2.0;

nlohmann::json reliability_json(const Reliability& reliability) {
  nlohmann::json bins = nlohmann::json::array();
  for (const Reliability::Bin& bin : reliability.bins)
    bins.push_back({{"count", bin.count}, {"forecast", bin.forecast}, {"came_true", bin.came_true}});
  return {{"bins", bins}, {"expected_error", reliability.expected_error}};
}

}  // namespace

ScoreboardTrials scoreboard_trials(const ScoreboardOptions& options) {
  ScoreboardTrials result;
  std::vector<Trial>& wholes = result.trials;
  std::vector<Trial> pieces;
  std::map<std::string, double> error;
  for (const auto& folder : find_cases(options.folder)) {
    const std::string name =
        folder == options.folder ? options.folder : folder.lexically_relative(options.folder).string();
    wholes.push_back(whole_case(folder, name));
    if (!options.cuts) continue;
    const Truth truth = read_truth(folder);
    std::vector<double> lengths_s{2.0, 4.0, 8.0};
    if (truth.effects.empty() && !truth.alien) {
      lengths_s.clear();
      for (double length_s = 1.0; length_s <= 10.0; length_s += 0.5) lengths_s.push_back(length_s);
    }
    for (Trial& piece : pieces_of_case(folder, name, lengths_s, true)) pieces.push_back(std::move(piece));
  }
  if (options.sample > 0) {
    std::mt19937_64 random(options.seed);
    for (auto* list : {&wholes, &pieces}) {
      std::ranges::shuffle(*list, random);
      list->resize(std::min(list->size(), options.sample));
      std::ranges::sort(*list, {}, &Trial::name);
    }
  }
  for (const Trial& piece : pieces) {
    const std::string folder = piece.folder.string();
    if (!error.contains(folder)) error[folder] = error_of_whole_case(piece.folder);
    result.has_something[piece.name] = error[folder] > kSomethingToFind;
  }
  std::ranges::move(pieces, std::back_inserter(wholes));
  return result;
}

Answer scoreboard_null(const ScoreboardOptions& options, std::size_t k) {
  return run_null(options.seed * 1'000'000 + k, fmt::format("null {}", k));
}

void AnswerCounts::add(const Answer& answer) {
  ++cases;
  ++outcomes[answer.outcome];
  if (answer.explained() >= kMostOfIt) ++most_explained;
}

std::size_t AnswerCounts::count(Outcome outcome) const {
  const auto found = outcomes.find(outcome);
  return found == outcomes.end() ? 0 : found->second;
}

AnswerSummaries::AnswerSummaries(const std::vector<Answer>& answers) {
  for (const Answer& answer : answers)
    (answer.truth.alien                 ? alien
     : answer.truth.effects.empty()     ? none
     : answer.truth.effects.size() == 1 ? single
                                        : pairs)
        .add(answer);
}

std::vector<Answer> whole_cases(const std::vector<Answer>& answers) {
  std::vector<Answer> whole;
  std::ranges::copy_if(answers, std::back_inserter(whole),
                       [](const Answer& answer) { return answer.group == "whole"; });
  return whole;
}

nlohmann::json scoreboard_json(const std::vector<Answer>& answers) {
  nlohmann::json cases = nlohmann::json::array();
  for (const Answer& answer : answers) {
    cases.push_back({{"case", answer.name},
                     {"group", answer.group},
                     {"truth", answer.truth.effects},
                     {"alien", answer.truth.alien},
                     {"outcome", std::string(outcome_name(answer.outcome))},
                     {"status", std::string(status_name(answer.verdict.status))},
                     {"effects", answer.verdict.effects},
                     {"alternatives", answer.verdict.alternatives},
                     {"coordinate", answer.verdict.coordinate},
                     {"forecasts", answer.forecasts},
                     {"before", answer.before},
                     {"after", answer.after},
                     {"explained", answer.explained()},
                     {"seconds", answer.seconds}});
  }
  const AnswerSummaries summaries(whole_cases(answers));
  const auto row = [](const AnswerCounts& summary) {
    nlohmann::json document = {{"cases", summary.cases}, {"most_explained", summary.most_explained}};
    for (const Outcome outcome : {Outcome::right, Outcome::group, Outcome::partly, Outcome::wrong, Outcome::missed})
      document[std::string(outcome_name(outcome))] = summary.count(outcome);
    return document;
  };
  return {{"format", "axis-scoreboard/1"},
          {"cases", cases},
          {"reliability", reliability_json(reliability_of(top_forecasts(answers)))},
          {"summary",
           {{"none", row(summaries.none)},
            {"single", row(summaries.single)},
            {"pairs", row(summaries.pairs)},
            {"alien", row(summaries.alien)}}}};
}

}  // namespace host
