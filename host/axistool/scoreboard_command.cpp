// axistool scoreboard: how often diagnose is right on records whose truth is known.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/insight_arguments.hpp"
#include "host/axistool/real_machines.hpp"
#include "host/scoreboard/rewriting.hpp"
#include "host/scoreboard/scoreboard.hpp"

namespace axistool {

namespace {

using host::Answer;
using host::Outcome;
using host::Status;

struct Arguments : host::ScoreboardOptions {
  std::string real, json;
  bool rewritten = false, left_out = false;
};

void print_head(std::size_t width) {
  fmt::print("{:<{}}  {:<8} {:>8} {:>8} {:>6}  {}\n", "case", width, "outcome", "before", "after", "s",
             "truth -> verdict");
}

void print(const Answer& answer, std::size_t width) {
  fmt::print("{:<{}}  {:<8} {:8.2f} {:8.2f} {:6.1f}  {} -> {} {}", answer.name, width,
             host::outcome_name(answer.outcome), answer.before, answer.after, answer.seconds,
             answer.truth.alien             ? "an alien"
             : answer.truth.effects.empty() ? "nothing"
                                            : fmt::format("{}", fmt::join(answer.truth.effects, " + ")),
             host::status_name(answer.verdict.status), fmt::join(answer.verdict.effects, ", "));
  for (const std::vector<std::string>& group : answer.verdict.alternatives)
    fmt::print(" ({})", fmt::join(group, " or "));
  if (!answer.verdict.coordinate.empty()) fmt::print("by {}", answer.verdict.coordinate);
  fmt::print("\n");
  std::fflush(stdout);
}

void print(const host::AnswerSummaries& summaries) {
  const auto& [none, single, pairs, alien] = summaries;
  fmt::print(
      "\n"
      "Whole cases. Errors are on validation data in multiples of the noise floor: 1 is perfect.\n");
  if (none.cases > 0) fmt::print("nothing hidden: {} cases, {} false claims\n", none.cases, none.count(Outcome::wrong));
  if (single.cases > 0)
    fmt::print(
        "one effect:     {} cases, {} right, {} in the right group, {} wrong, {} missed; {} have {:g} % of the "
        "explainable squared error gone\n",
        single.cases, single.count(Outcome::right), single.count(Outcome::group), single.count(Outcome::wrong),
        single.count(Outcome::missed), single.most_explained, 100.0 * host::kMostOfIt);
  if (pairs.cases > 0)
    fmt::print("several:        {} cases, {} all found, {} some found, {} wrong, {} missed; {} have {:g} % gone\n",
               pairs.cases, pairs.count(Outcome::right), pairs.count(Outcome::partly), pairs.count(Outcome::wrong),
               pairs.count(Outcome::missed), pairs.most_explained, 100.0 * host::kMostOfIt);
  if (alien.cases > 0)
    fmt::print("in no catalogue: {} cases, {} called adequate or given a name\n", alien.cases,
               alien.count(Outcome::wrong));
}

/// Prints one line for each way of cutting cases. `worth`: whether the whole case of a piece has an effect to find.
void print_pieces(const std::vector<Answer>& answers, const std::map<std::string, bool>& worth) {
  struct Line {
    std::size_t pieces = 0, right = 0, wrong = 0, unexplained = 0, insufficient = 0, all_clear = 0, false_all_clear = 0;
  };
  std::map<std::string, Line> lines;
  std::size_t claims = 0, wrong = 0;
  for (const Answer& answer : answers) {
    if (answer.group == "whole" || answer.group == "simulated") continue;
    Line& line =
        lines[answer.truth.effects.empty() && !answer.truth.alien ? answer.group + ", nothing hidden" : answer.group];
    ++line.pieces;
    const bool names = !answer.verdict.effects.empty();
    if (names) ++claims;
    if (names && answer.outcome == Outcome::wrong) ++wrong, ++line.wrong;
    if (names && answer.outcome != Outcome::wrong) ++line.right;
    if (answer.verdict.status == Status::unexplained) ++line.unexplained;
    if (answer.verdict.status == Status::insufficient_data) ++line.insufficient;
    if (answer.gives_all_clear()) {
      ++line.all_clear;
      if (worth.at(answer.name)) ++line.false_all_clear;
    }
  }
  if (lines.empty()) return;
  fmt::print("\n{:<28} {:>7} {:>7} {:>7} {:>12} {:>13} {:>10} {:>9}\n", "Pieces of cases", "trials", "named", "wrong",
             "unexplained", "insufficient", "all-clear", "of them");
  fmt::print("{:<28} {:>7} {:>7} {:>7} {:>12} {:>13} {:>10} {:>9}\n", "", "", "right", "name", "", "", "", "false");
  for (const auto& [group, line] : lines)
    fmt::print("{:<28} {:>7} {:>7} {:>7} {:>12} {:>13} {:>10} {:>9}\n", group, line.pieces, line.right, line.wrong,
               line.unexplained, line.insufficient, line.all_clear, line.false_all_clear);
  fmt::print("{} of {} named effects are wrong.\n", wrong, claims);
}

void print_nulls(const std::vector<Answer>& answers) {
  std::size_t trials = 0, claims = 0, unexplained = 0, clear = 0;
  for (const Answer& answer : answers) {
    if (answer.group != "simulated") continue;
    ++trials;
    if (!answer.verdict.effects.empty()) ++claims;
    if (answer.verdict.status == Status::unexplained) ++unexplained;
    if (answer.gives_all_clear()) ++clear;
  }
  if (trials > 0)
    fmt::print("\nSimulated with nothing hidden: {} trials, {} claims ({:.1f} %), {} unexplained, {} all-clear\n",
               trials, claims, 100.0 * static_cast<double>(claims) / static_cast<double>(trials), unexplained, clear);
}

void print(const char* title, const host::Reliability& reliability) {
  fmt::print("\n{}: expected calibration error {:.1f} %\n  said    trials  mean  came true\n", title,
             100.0 * reliability.expected_error);
  for (std::size_t k = 0; k < reliability.bins.size(); ++k) {
    const host::Reliability::Bin& bin = reliability.bins[k];
    if (bin.count > 0)
      fmt::print("  {:2}–{:3} % {:6} {:4.0f} % {:8.0f} %\n", 10 * k, 10 * k + 10, bin.count, 100.0 * bin.forecast,
                 100.0 * bin.came_true);
  }
}

/// Runs the whole cases, each with its own effect removed from the catalogue.
void run_left_out(const std::vector<host::Trial>& trials, std::size_t width, bool talks, const std::string& json) {
  nlohmann::json lines = nlohmann::json::array();
  std::map<Outcome, std::size_t> outcomes;
  std::size_t coordinates = 0;
  for (const host::Trial& trial : trials) {
    SearchProgress progress(trial.name);
    const host::LeftOut result = host::leave_out(trial, progress.callback());
    ++outcomes[result.answer.outcome];
    if (result.right_coordinate) ++coordinates;
    lines.push_back({{"case", trial.name},
                     {"right_coordinate", result.right_coordinate},
                     {"truth", result.answer.truth.effects},
                     {"outcome", std::string(host::outcome_name(result.answer.outcome))},
                     {"status", std::string(host::status_name(result.answer.verdict.status))},
                     {"effects", result.answer.verdict.effects},
                     {"coordinate", result.answer.verdict.coordinate},
                     {"before", result.answer.before},
                     {"curve_over", result.over},
                     {"curve_takes", result.curve}});
    if (!talks) continue;
    print(result.answer, width);
    if (result.over.empty())
      fmt::print("{:<{}}  no curve\n", "", width);
    else
      fmt::print("{:<{}}  a curve over {} explains {:.0f} % of the explainable error\n", "", width, result.over,
                 100.0 * result.curve);
    std::fflush(stdout);
  }
  if (talks)
    fmt::print(
        "With the effect of each case left out of the catalogue: {} cases, {} without a name, {} near relatives, {} "
        "wrong; the right coordinate or a relative in {}\n",
        lines.size(), outcomes[Outcome::right], outcomes[Outcome::group], outcomes[Outcome::wrong], coordinates);
  if (!json.empty()) write_json({{"format", "axis-left-out/1"}, {"trials", lines}}, json);
}

/// Runs the whole cases in rewritten forms; prints one line for each form.
void run_rewritten(const std::vector<host::Trial>& trials, std::size_t width, bool talks, const std::string& json) {
  constexpr double kMostRatio = 1.1;
  nlohmann::json lines = nlohmann::json::array();
  std::size_t verdicts = 0, parameters = 0, errors = 0;
  for (const host::Trial& trial : trials) {
    const auto results = host::try_rewritings(host::read_question(trial), host::rewritings());
    for (std::size_t k = 0; k < results.size(); ++k) {
      const host::Invariance& result = results[k];
      const std::string_view name = host::rewritings()[k].name;
      if (!result.same_verdict) ++verdicts;
      if (result.worst_parameter > 1.0) ++parameters;
      if (result.error_ratio > kMostRatio) ++errors;
      lines.push_back({{"case", trial.name},
                       {"rewriting", name},
                       {"verdict", result.original},
                       {"rewritten_verdict", result.rewritten},
                       {"worst_parameter", result.worst_parameter},
                       {"error_ratio", result.error_ratio}});
      if (!talks) continue;
      fmt::print("{:<{}}  {:<12} {:8.3f} {:8.3f}  {}{}\n", trial.name, width, name, result.worst_parameter,
                 result.error_ratio, result.original,
                 result.same_verdict ? "" : fmt::format(" -> {}", result.rewritten));
      std::fflush(stdout);
    }
  }
  if (talks)
    fmt::print(
        "{} trials: {} another verdict, {} a base parameter outside its interval, {} an error more than {:g} % "
        "off\n",
        lines.size(), verdicts, parameters, errors, 100.0 * (kMostRatio - 1.0));
  if (!json.empty()) write_json({{"format", "axis-invariance/1"}, {"trials", lines}}, json);
}

void run(const Arguments& arguments) {
  const bool talks = arguments.json != "-";
  const host::ScoreboardTrials chosen = host::scoreboard_trials(arguments);
  const std::vector<host::Trial>& trials = chosen.trials;
  std::size_t width = 4;
  for (const host::Trial& trial : trials) width = std::max(width, trial.name.size());
  if (arguments.left_out) return run_left_out(trials, width, talks, arguments.json);
  if (arguments.rewritten) return run_rewritten(trials, width, talks, arguments.json);
  if (talks) print_head(width);
  std::vector<Answer> answers;
  const auto note = [&](Answer answer) {
    answers.push_back(std::move(answer));
    if (talks) print(answers.back(), width);
  };
  for (const host::Trial& trial : trials) {
    SearchProgress progress(trial.name);
    note(host::run_trial(trial, progress.callback()));
  }
  for (std::uint64_t k = 0; k < arguments.nulls; ++k) note(host::scoreboard_null(arguments, k));
  if (!arguments.json.empty()) write_json(host::scoreboard_json(answers), arguments.json);
  if (!talks) return;
  print(host::AnswerSummaries(host::whole_cases(answers)));
  print_pieces(answers, chosen.has_something);
  print_nulls(answers);
  print("Most probable effect of each answer", host::reliability_of(host::top_forecasts(answers)));
  print("All stated probabilities", host::reliability_of(host::all_forecasts(answers)));
}

}  // namespace

void add_scoreboard(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("scoreboard", "show how often diagnose is right on cases whose truth is known");
  command->add_option(
      "FOLDER", arguments->folder,
      "folder with cases at any depth: each a folder with model.toml, train-*.csv, validate.csv, truth.json");
  command->add_option(
      "--real", arguments->real,
      "instead: folder of measured machines, a folder each, and expected.json with their right answers");
  command->add_flag("--cuts", arguments->cuts,
                    "also each training record alone, each pair, and their first 2, 4 and 8 s (1 to 10 s where nothing "
                    "is hidden)");
  command->add_flag("--rewritten", arguments->rewritten,
                    "instead: rewrite each whole case without changing its physics (other volt scale, linear for "
                    "rotary, mirrored, cut in two ...), and show how far the answers differ");
  command->add_flag(
      "--left-out", arguments->left_out,
      "instead: remove each whole case's effect from the catalogue, and show how much a free curve explains");
  command->add_option("--nulls", arguments->nulls, "also this many simulated drives without a hidden effect");
  command->add_option("--sample", arguments->sample, "only this many cases and cuts, drawn at random");
  command->add_option("--seed", arguments->seed, "seed of the sample and of the simulated drives")
      ->capture_default_str();
  add_json_option(*command, arguments->json);
  command->footer(
      "Example:\n"
      "  axistool scoreboard tests/data/drive-cases --cuts --sample 5\n"
      "Exit code 0 for any result; 9 for a bad file or a folder without cases.");
  command->callback([arguments] {
    if (arguments->folder.empty() == arguments->real.empty())
      throw host::Failure(host::ExitCode::usage, "give either a folder of cases or --real DIR");
    if (arguments->real.empty())
      run(*arguments);
    else
      score_real_machines(arguments->real, arguments->json);
  });
}

}  // namespace axistool
