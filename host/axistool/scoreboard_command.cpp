// axistool scoreboard: what diagnose answers on cases whose truth is known.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/insight_arguments.hpp"
#include "host/diagnose/verdict.hpp"

namespace axistool {

namespace {

namespace fs = std::filesystem;
using Kinds = std::vector<std::string>;

/// Part of the explainable squared error that an answer should remove.
constexpr double kMostOfIt = 0.8;

enum class Outcome { right, group, partly, wrong, missed };

struct Score {
  std::string name;
  Kinds truth;
  host::DiagnosisVerdict verdict;
  double before = 0.0, after = 0.0;  ///< combined, on validation data
  double seconds = 0.0;
  Outcome outcome = Outcome::missed;

  /// Part of the squared error above the floor that is gone; 0 where there was none.
  double explained() const {
    const double there_is = before * before - 1.0;
    return there_is > 0.0 ? (before * before - after * after) / there_is : 0.0;
  }
};

std::string_view outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::right:
      return "right";
    case Outcome::group:
      return "group";
    case Outcome::partly:
      return "partly";
    case Outcome::wrong:
      return "wrong";
    case Outcome::missed:
      return "missed";
  }
  return "";
}

/// Right: exactly the truth. Group: an ambiguous answer that contains it. Partly: some of several effects, and nothing
/// else. Wrong: something that is not there. Missed: no claim where there was something to find.
Outcome outcome_of(const Kinds& truth, const host::DiagnosisVerdict& verdict) {
  const auto claims = [&](const std::string& kind) {
    return std::ranges::find(verdict.effects, kind) != verdict.effects.end();
  };
  const auto is_true = [&](const std::string& kind) { return std::ranges::find(truth, kind) != truth.end(); };
  if (verdict.effects.empty()) return truth.empty() ? Outcome::right : Outcome::missed;
  if (std::ranges::is_permutation(truth, verdict.effects) && verdict.status == host::Status::missing)
    return Outcome::right;
  if (verdict.status == host::Status::ambiguous && !truth.empty() && std::ranges::all_of(truth, claims))
    return Outcome::group;
  return std::ranges::all_of(verdict.effects, is_true) ? Outcome::partly : Outcome::wrong;
}

Kinds read_truth(const fs::path& file) {
  std::ifstream in(file);
  try {
    return nlohmann::json::parse(in).at("effects").get<Kinds>();
  } catch (const nlohmann::json::exception& error) {
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: no list \"effects\" of kinds ({})", file.string(), error.what()));
  }
}

/// Folders at any depth that hold a case, in the order of their names.
std::vector<fs::path> find_cases(const std::string& folder) {
  if (!fs::is_directory(folder))
    throw host::Failure(host::ExitCode::bad_input, folder + ": no such folder; give the folder that holds the cases");
  std::vector<fs::path> cases;
  const auto add = [&cases](const fs::path& path) {
    if (fs::exists(path / "truth.json") && fs::exists(path / "model.toml") && fs::exists(path / "validate.csv"))
      cases.push_back(path);
  };
  add(folder);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory()) add(entry.path());
  if (cases.empty())
    throw host::Failure(host::ExitCode::bad_input,
                        folder +
                            ": no case below; a case is a folder with model.toml, train-*.csv, validate.csv and "
                            "truth.json");
  std::ranges::sort(cases);
  return cases;
}

InsightArguments arguments_of(const fs::path& folder) {
  InsightArguments arguments;
  arguments.model = (folder / "model.toml").string();
  arguments.validate = {(folder / "validate.csv").string()};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("train-") && entry.path().extension() == ".csv")
      arguments.train.push_back(entry.path().string());
  if (arguments.train.empty())
    throw host::Failure(host::ExitCode::bad_input, folder.string() + ": no training record; add train-*.csv");
  std::ranges::sort(arguments.train);
  return arguments;
}

Score score(const fs::path& folder, const std::string& name) {
  const auto begin = std::chrono::steady_clock::now();
  const InsightRecords records(arguments_of(folder));
  host::Diagnosis diagnosis;
  {
    SearchProgress progress(name);
    diagnosis = host::diagnose(records.model, records.measurements, progress.callback());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  Score result{name,
               read_truth(folder / "truth.json"),
               diagnosis.verdict,
               diagnosis.before_validate,
               diagnosis.after_validate,
               took.count()};
  result.outcome = outcome_of(result.truth, result.verdict);
  return result;
}

/// Counts over the cases that hide nothing, one effect, or several.
struct Summary {
  std::size_t cases = 0, most_explained = 0;
  std::map<Outcome, std::size_t> outcomes;

  void add(const Score& score) {
    ++cases;
    ++outcomes[score.outcome];
    if (score.explained() >= kMostOfIt) ++most_explained;
  }
  std::size_t count(Outcome outcome) const {
    const auto found = outcomes.find(outcome);
    return found == outcomes.end() ? 0 : found->second;
  }
};

struct Summaries {
  Summary none, single, pairs;

  explicit Summaries(const std::vector<Score>& scores) {
    for (const Score& score : scores)
      (score.truth.empty() ? none : score.truth.size() == 1 ? single : pairs).add(score);
  }
};

nlohmann::json to_json(const std::vector<Score>& scores) {
  nlohmann::json cases = nlohmann::json::array();
  for (const Score& score : scores)
    cases.push_back({{"case", score.name},
                     {"truth", score.truth},
                     {"outcome", std::string(outcome_name(score.outcome))},
                     {"status", std::string(host::status_name(score.verdict.status))},
                     {"effects", score.verdict.effects},
                     {"alternatives", score.verdict.alternatives},
                     {"before", score.before},
                     {"after", score.after},
                     {"explained", score.explained()},
                     {"seconds", score.seconds}});
  const Summaries summaries(scores);
  const auto row = [](const Summary& summary) {
    nlohmann::json document = {{"cases", summary.cases}, {"most_explained", summary.most_explained}};
    for (const Outcome outcome : {Outcome::right, Outcome::group, Outcome::partly, Outcome::wrong, Outcome::missed})
      document[std::string(outcome_name(outcome))] = summary.count(outcome);
    return document;
  };
  return {
      {"format", "axis-scoreboard/1"},
      {"cases", cases},
      {"summary", {{"none", row(summaries.none)}, {"single", row(summaries.single)}, {"pairs", row(summaries.pairs)}}}};
}

void print_head(std::size_t width) {
  fmt::print("{:<{}}  {:<8} {:>8} {:>8} {:>6}  {}\n", "case", width, "outcome", "before", "after", "s",
             "truth -> verdict");
}

void print(const Score& score, std::size_t width) {
  fmt::print("{:<{}}  {:<8} {:8.2f} {:8.2f} {:6.1f}  {} -> {} {}", score.name, width, outcome_name(score.outcome),
             score.before, score.after, score.seconds,
             score.truth.empty() ? "nothing" : fmt::format("{}", fmt::join(score.truth, " + ")),
             host::status_name(score.verdict.status), fmt::join(score.verdict.effects, ", "));
  for (const Kinds& group : score.verdict.alternatives) fmt::print(" ({})", fmt::join(group, " or "));
  fmt::print("\n");
  std::fflush(stdout);
}

void print(const Summaries& summaries) {
  const Summary &none = summaries.none, &single = summaries.single, &pairs = summaries.pairs;
  fmt::print("\nErrors are on validation data over the floor: 1 is perfect.\n");
  if (none.cases > 0) fmt::print("nothing hidden: {} cases, {} false claims\n", none.cases, none.count(Outcome::wrong));
  if (single.cases > 0)
    fmt::print(
        "one effect:     {} cases, {} right, {} in the right group, {} wrong, {} missed; {} have {:g} % of the "
        "explainable squared error gone\n",
        single.cases, single.count(Outcome::right), single.count(Outcome::group), single.count(Outcome::wrong),
        single.count(Outcome::missed), single.most_explained, 100.0 * kMostOfIt);
  if (pairs.cases > 0)
    fmt::print("two effects:    {} cases, {} both found, {} one found, {} wrong, {} missed; {} have {:g} % gone\n",
               pairs.cases, pairs.count(Outcome::right), pairs.count(Outcome::partly), pairs.count(Outcome::wrong),
               pairs.count(Outcome::missed), pairs.most_explained, 100.0 * kMostOfIt);
}

void run(const std::string& folder, const std::string& json) {
  const std::vector<fs::path> cases = find_cases(folder);
  const auto name_of = [&](const fs::path& path) {
    return path == folder ? folder : path.lexically_relative(folder).string();
  };
  std::size_t width = 4;
  for (const fs::path& path : cases) width = std::max(width, name_of(path).size());
  const bool talks = json != "-";
  if (talks) print_head(width);
  std::vector<Score> scores;
  for (const fs::path& path : cases) {
    scores.push_back(score(path, name_of(path)));
    if (talks) print(scores.back(), width);
  }
  if (!json.empty()) write_json(to_json(scores), json);
  if (talks) print(Summaries(scores));
}

}  // namespace

void add_scoreboard(CLI::App& app) {
  struct Arguments {
    std::string folder, json;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("scoreboard", "how often diagnose is right on cases whose truth is known");
  command
      ->add_option(
          "FOLDER", arguments->folder,
          "folder with cases at any depth: each a folder with model.toml, train-*.csv, validate.csv, truth.json")
      ->required();
  add_json_option(*command, arguments->json);
  command->footer(
      "Example:\n  axistool scoreboard tests/data/drive-cases\n"
      "Exit code 0 whatever the answers are; 9 for a bad file or a folder without cases.");
  command->callback([arguments] { run(arguments->folder, arguments->json); });
}

}  // namespace axistool
