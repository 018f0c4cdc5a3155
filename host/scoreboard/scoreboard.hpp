// Selects trials for a scoreboard and counts the right answers of each kind.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/scoreboard/answer.hpp"

namespace host {

/// Part of the explainable squared error that an answer should remove.
inline constexpr double kMostOfIt = 0.8;

struct ScoreboardOptions {
  std::string folder;      ///< folder with cases at any depth
  bool cuts = false;       ///< also pieces of each case
  std::size_t sample = 0;  ///< only this many cases and cuts, drawn at random; 0: all
  std::uint64_t seed = 1;  ///< seed of the sample and of the simulated drives
  std::size_t nulls = 0;   ///< also this many simulated drives without a hidden effect
};

/// Whole cases first, then their pieces.
struct ScoreboardTrials {
  std::vector<Trial> trials;
  std::map<std::string, bool> has_something;  ///< by a piece's name: whether its whole case has an effect to find
};

/// Throws Failure(bad_input) as find_cases() and read_truth() do.
ScoreboardTrials scoreboard_trials(const ScoreboardOptions& options);

/// Answers one null trial: number `k` of `options.nulls`.
Answer scoreboard_null(const ScoreboardOptions& options, std::size_t k);

/// Counts over answers of a kind.
struct AnswerCounts {
  std::size_t cases = 0, most_explained = 0;
  std::map<Outcome, std::size_t> outcomes;

  void add(const Answer& answer);
  std::size_t count(Outcome outcome) const;
};

/// Grouped by the hidden effects of the cases.
struct AnswerSummaries {
  AnswerCounts none, single, pairs, alien;

  explicit AnswerSummaries(const std::vector<Answer>& answers);
};

/// Answers to whole cases only.
std::vector<Answer> whole_cases(const std::vector<Answer>& answers);

/// `axis-scoreboard/1`.
nlohmann::json scoreboard_json(const std::vector<Answer>& answers);

}  // namespace host
