#include "host/diagnose/improvement_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>

#include "host/diagnose/diagnosis_figures.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

std::string join_words(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  return text;
}

/// "18.6 → 0.78 × noise floor"; empty without validation.
std::string fall(const Improvement& improvement) {
  const double before = improvement.first.given_error.validate.combined, after = improvement.error.validate.combined;
  if (!(before > 0.0) || !std::isfinite(before) || !std::isfinite(after)) return "";
  return fmt::format("{} → {} × noise floor", format_value(before), format_value(after));
}

std::vector<std::string> added_kinds(const Improvement& improvement) {
  std::vector<std::string> added;
  if (improvement.kept_given) return added;
  for (const Rung& rung : improvement.ladder) added.insert(added.end(), rung.added.begin(), rung.added.end());
  return added;
}

/// Errors of the refitted base and of the resulting model.
std::vector<ChannelError> channels_of(const Improvement& improvement) {
  return channel_errors(improvement.ladder.front().error.validate, improvement.error.validate,
                        improvement.first.effort);
}

std::string headline(const Improvement& improvement) {
  if (improvement.is_refused) return "No better model was found; the given one is kept";
  const std::vector<std::string> added = added_kinds(improvement);
  if (!added.empty()) return fmt::format("{} by adding {}", fall(improvement), join_words(added));
  constexpr double kLower = 0.95;  // of the error; a refit that lowers it by less does not count
  const Status status = improvement.verdict.status;
  const double given = improvement.first.given_error.validate.combined, left = improvement.error.validate.combined;
  if (left < kLower * given && (status == Status::unexplained || status == Status::insufficient_data))
    return fmt::format("{} by refitting the parameters; no effect was added", fall(improvement));
  switch (status) {
    case Status::adequate:
      return "Nothing had to be added: the model explains these measurements";
    case Status::parameters:
      return fmt::format("{} by refitting the parameters: {} were wrong", fall(improvement),
                         join_words(improvement.verdict.parameters));
    case Status::insufficient_data:
      return "Nothing was added: these motions show too little";
    case Status::missing:
    case Status::ambiguous:
    case Status::unexplained:
      break;
  }
  return "Nothing was added: no known effect explains the residual";
}

std::string parameters_file(const std::string& model) {
  const std::filesystem::path path(model);
  return (path.parent_path() / (path.stem().string() + "-params.toml")).string();
}

}  // namespace

Verdict improvement_verdict(const Improvement& improvement, const ImprovementFiles& files) {
  Verdict verdict;
  const bool added = improvement.ladder.size() > 1 && !improvement.kept_given;
  const bool fits = improvement.error.validate.combined <= kExplained;
  const Status last = improvement.verdict.status;
  const bool done = last == Status::adequate || last == Status::parameters || fits;
  verdict.tone = done ? Tone::good : added ? Tone::attention : last == Status::unexplained ? Tone::bad : Tone::neutral;
  if (improvement.is_refused) verdict.tone = Tone::bad;
  verdict.label = improvement.is_refused ? "not improved" : added ? "improved" : std::string(status_name(last));
  verdict.headline = headline(improvement);
  for (const LogFault& fault : improvement.first.log)
    verdict.sentences.push_back(fmt::format("{}: {}.", fault.accepted ? "Accepted" : "Doubtful", fault.message));
  verdict.sentences.push_back(
      fmt::format("Stopped because {}. {}", improvement.stopped_because, improvement.verdict.explanation));
  if (!done) verdict.sentences.push_back("Next: " + improvement.verdict.next_experiment);
  if (improvement.is_refused) {
    verdict.sentences.push_back(fmt::format("{} holds the model as given.", files.output));
    return verdict;
  }
  verdict.sentences.push_back(
      fmt::format("The model is in {}. Next, make the board's parameters from it:", files.output));
  verdict.command =
      fmt::format("axistool design {} -o {}", shell_word(files.output), shell_word(parameters_file(files.output)));
  return verdict;
}

BarChart ladder_chart(const Improvement& improvement) {
  BarChart chart;
  chart.title = "Error after each step";
  chart.caption = "In multiples of the noise floor.";
  chart.series = {{"train", SeriesRole::train}, {"validation", SeriesRole::validate}};
  chart.reference = {"noise floor", 1.0};
  const auto add = [&chart](const std::string& name, const ErrorOnSets& error) {
    chart.rows.push_back({name, {error.train.combined, error.validate.combined}, ""});
  };
  add("as given", improvement.first.given_error);
  for (const Rung& rung : improvement.ladder)
    add(rung.added.empty() ? "base re-fitted" : fmt::format("+ {}", fmt::join(rung.added, " + ")), rung.error);
  return chart;
}

void write_improvement_report(const Improvement& improvement, const ImprovementFiles& files, const std::string& path) {
  Report report("Improvement of " + std::filesystem::path(files.model).filename().string(),
                fmt::format("{} → {}", files.model, files.output));
  const std::vector<std::string> added = added_kinds(improvement);
  const std::vector<FoundEffect> found = found_effects(improvement.model, added, improvement.first);
  Verdict verdict = improvement_verdict(improvement, files);
  std::vector<std::string> sizes{kNoiseFloorMeans};
  for (const FoundEffect& effect : found) sizes.push_back(size_in_words(effect) + ".");
  if (!added.empty()) sizes.push_back(errors_in_words(channels_of(improvement)));
  verdict.sentences.insert(verdict.sentences.begin(), sizes.begin(), sizes.end());
  // Inserted before the last sentence, which introduces the command.
  const std::vector<std::string> what_to_do = remedies(added);
  verdict.sentences.insert(verdict.sentences.end() - 1, what_to_do.begin(), what_to_do.end());
  report.verdict(std::move(verdict));
  add_found(report, found, false);
  report.section("The error falls");
  report.add(ladder_chart(improvement));
  report.add(error_table(channels_of(improvement), !added.empty()));
  if (!improvement.first.candidates.empty()) {
    report.section("Effects tried at the first step");
    add_candidates(report, improvement.first);
  }
  add_residuals(report, improvement.first, improvement.model, !added.empty());
  add_traces(report, improvement.first, improvement.model, !added.empty());
  report.write(path);
}

}  // namespace host
