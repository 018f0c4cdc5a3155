#include "host/compare/comparison_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>
#include <system_error>

#include "host/compare/free_run.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/report/text_format.hpp"
#include "host/scale/table_figures.hpp"

namespace host {

namespace {

constexpr double kAtFloor = 1.2;  ///< largest combined error at which nothing remains to be explained
constexpr double kNear = 2.0;
constexpr double kMuchBetter = 1.5;  ///< least ratio of the errors without and with the effects for "helps"

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

/// The records to which a model was fitted, according to its entries.
std::vector<std::string> training_files(const sim::DriveDescription& model) {
  std::vector<std::string> files;
  const auto take = [&](const std::string& name) {
    if (!name.empty() && std::ranges::find(files, name) == files.end()) files.push_back(name);
  };
  for (const sim::EffectEntry& entry : model.effects) {
    std::istringstream list(entry.from);
    for (std::string piece; std::getline(list, piece, ',');) {
      piece.erase(0, piece.find_first_not_of(' '));
      std::istringstream words(piece);
      if (std::filesystem::exists(piece))
        take(piece);
      else
        for (std::string word; words >> word;) take(word);
    }
  }
  std::erase_if(files, [](const std::string& name) { return !std::filesystem::is_regular_file(name); });
  return files;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;
  return a == b || std::filesystem::equivalent(a, b, unknown);
}

/// Training records are those to which the model was fitted, if known; never a held-back record.
std::string diagnose_command(const ComparedModel& compared) {
  std::vector<std::string> train = training_files(compared.model), validate;
  for (const RecordError& record : compared.comparison.records) {
    const bool trained =
        std::ranges::any_of(train, [&](const std::string& name) { return is_same_file(name, record.path); });
    if (!trained) validate.push_back(record.path);
  }
  if (train.empty()) train = {"TRAINING.csv"};
  std::string command = "axistool diagnose " + shell_word(compared.path) + " --train";
  for (const std::string& path : train) command += " " + shell_word(path);
  if (!validate.empty()) command += " --validate";
  for (const std::string& path : validate) command += " " + shell_word(path);
  return command;
}

std::string names_of(const std::vector<std::string>& kinds) {
  std::vector<std::string> names;
  for (const std::string& kind : kinds) names.push_back(spaced(kind));
  return fmt::format("{}", fmt::join(names, ", "));
}

Verdict verdict_of(const ComparedModel& compared) {
  const ModelComparison& comparison = compared.comparison;
  Verdict verdict;
  const std::string times = format_value(comparison.error.combined);
  if (!comparison.log_faults.empty()) {
    verdict.tone = Tone::bad;
    verdict.label = "check the log";
    verdict.headline = comparison.log_faults.size() == 1
                           ? "The record has a fault that no model can explain; correct it first."
                           : fmt::format("The records have {} faults that no model can explain; correct them first.",
                                         comparison.log_faults.size());
    for (const LogFault& fault : comparison.log_faults) verdict.sentences.push_back(fault.message + ".");
  } else if (comparison.error.combined <= kAtFloor) {
    verdict.tone = Tone::good;
    verdict.label = "fits";
    verdict.headline =
        fmt::format("The model predicts these records as well as any could (error {} × noise floor).", times);
    return verdict;
  } else {
    const bool nearly = comparison.error.combined <= kNear, helps = comparison.without_effects >= kMuchBetter;
    const ChannelFigures* worst = comparison.error.worst();
    verdict.tone = nearly || helps ? Tone::attention : Tone::bad;
    verdict.label = nearly ? "nearly fits" : helps ? "fits in part" : "does not fit";
    verdict.headline = helps
                           ? fmt::format("{} times better than without {}; the error is {} times the noise floor",
                                         format_value(comparison.without_effects), names_of(comparison.effects), times)
                           : fmt::format("The prediction error is {} times the noise floor", times);
    if (worst != nullptr && worst->share)
      verdict.headline +=
          fmt::format(", {} % of the signal in {}", format_value(100.0 * *worst->share, 2), worst->name);
    verdict.headline += ".";
  }
  verdict.sentences.push_back(capitalised(where_it_fails(comparison.where)) + ".");
  if (comparison.log_faults.empty()) {
    verdict.command = diagnose_command(compared);
    verdict.sentences.push_back(training_files(compared.model).empty()
                                    ? "Next: find the missing effect, with other records for training."
                                    : "Next: find the missing effect.");
  }
  return verdict;
}

/// Verdict on several models: the one that fits best, and the others in comparison.
Verdict verdict_of(std::span<const ComparedModel> models) {
  const auto best =
      std::ranges::min_element(models, {}, [](const ComparedModel& one) { return one.comparison.error.combined; });
  Verdict verdict = verdict_of(*best);
  if (models.size() == 1) return verdict;
  verdict.sentences.insert(verdict.sentences.begin(), verdict.headline);
  const double least = best->comparison.error.combined;
  verdict.headline = fmt::format("{} predicts best: {} × noise floor", best->name(), format_value(least));
  for (const ComparedModel& one : models) {
    if (&one == &*best) continue;
    const double more = one.comparison.error.combined;
    verdict.headline += fmt::format("; {} {}", one.name(), format_value(more));
    if (least > 0.0 && more > kMuchBetter * least)
      verdict.headline += fmt::format(", {} times as much", format_value(more / least));
  }
  return verdict;
}

Table error_table(std::span<const ComparedModel> models) {
  const ModelComparison& first = models.front().comparison;
  Table table;
  table.title = "Prediction error";
  table.caption = fmt::format(
      "Predicted from the recorded command over {:g} s, restarted from the smoothed measurement.{}",
      first.error.window_s, models.size() > 1 ? " Each model has its own noise floor; compare the RMS errors." : "");
  table.headings = {"record", "channel", "unit", "RMS error", "floor", "fit", "error/floor", "inverse model"};
  if (models.size() > 1) table.headings.insert(table.headings.begin() + 1, "model");
  const auto append = [&](const std::string& name, const ComparedModel& model, bool is_first,
                          const std::vector<ChannelFigures>& channels, double combined,
                          const std::optional<double>& relative_error) {
    bool first_channel = true;
    for (const ChannelFigures& channel : channels) {
      std::vector<std::string> row{is_first && first_channel ? name : "",
                                   channel.name,
                                   channel.unit,
                                   format_value(channel.rms),
                                   format_value(channel.floor),
                                   fmt::format("{:.2f} %", channel.fit_percent),
                                   first_channel ? format_value(combined) : "",
                                   first_channel && relative_error ? percent(*relative_error) : ""};
      if (models.size() > 1) row.insert(row.begin() + 1, first_channel ? model.name() : "");
      table.rows.push_back(std::move(row));
      first_channel = false;
    }
  };
  for (std::size_t r = 0; r < first.records.size(); ++r)
    for (const ComparedModel& one : models) {
      const RecordError& record = one.comparison.records[r];
      append(file_name(record.path), one, &one == &models.front(), record.error.channels, record.error.combined,
             record.relative_error);
    }
  if (first.records.size() > 1)
    for (const ComparedModel& one : models)
      append("all", one, &one == &models.front(), one.comparison.error.channels, one.comparison.error.combined,
             one.comparison.relative_error);
  return table;
}

/// The regions whose share of the error exceeds their share of the samples most.
std::vector<ErrorRegion> outstanding(const std::vector<ErrorRegion>& where, std::size_t most) {
  std::vector<ErrorRegion> regions;
  for (const ErrorRegion& region : where)
    if (region.partition != "event" && region.partition != "place" && region.partition != "frequency" &&
        region.portion > 0.0 && region.share > region.portion && region.share > 0.05)
      regions.push_back(region);
  std::ranges::sort(regions, std::greater(),
                    [](const ErrorRegion& region) { return region.share * std::log(region.share / region.portion); });
  regions.resize(std::min(most, regions.size()));
  return regions;
}

BarChart bars_of(const std::vector<ErrorRegion>& where, const std::string& partition, const std::string& title) {
  BarChart chart;
  chart.title = title;
  chart.unit = "%";
  chart.series = {{"squared error", SeriesRole::residual}, {"samples", SeriesRole::floor}};
  chart.folded = partition == "time";
  if (partition == "order") chart.series.pop_back();
  for (const ErrorRegion& region : where) {
    if (region.partition != partition) continue;
    std::string label = region.region;
    std::ranges::replace(label, '_', ' ');
    BarRow row{label, {rounded_to_digits(100.0 * region.share, 3)}, {}};
    if (partition != "order") {
      row.values.push_back(rounded_to_digits(100.0 * region.portion, 3));
      row.note = format_value(region.rms) + " × floor";
    }
    chart.rows.push_back(std::move(row));
  }
  return chart;
}

/// Error over noise floor of each model, in the regions of a partition that all models have in common with the first.
BarChart overlaid_bars(std::span<const ComparedModel> models, const std::string& partition, const std::string& title) {
  BarChart chart;
  chart.title = title;
  chart.caption = "Error over floor.";
  chart.reference = {"floor", 1.0};
  for (std::size_t m = 0; m < models.size(); ++m) chart.series.push_back({models[m].name(), role_of_model(m)});
  for (const ErrorRegion& region : models.front().comparison.where) {
    if (region.partition != partition) continue;
    BarRow row{region.region, {}, {}};
    std::ranges::replace(row.label, '_', ' ');
    for (const ComparedModel& one : models) {
      const auto same = std::ranges::find_if(one.comparison.where, [&](const ErrorRegion& other) {
        return other.partition == partition && other.region == region.region;
      });
      row.values.push_back(same == one.comparison.where.end() ? std::nan("") : same->rms);
    }
    chart.rows.push_back(std::move(row));
  }
  return chart;
}

void add_where_it_fails(std::span<const ComparedModel> models, Report& report) {
  const auto add = [&report](BarChart chart) {
    if (!chart.rows.empty()) report.add(std::move(chart));
  };
  if (models.size() > 1) {
    report.section("Where they fail");
    for (const auto& [partition, title] : {std::pair("regime", "By what the axis does"), std::pair("speed", "By speed"),
                                           std::pair("position", "By position along the travel")})
      add(overlaid_bars(models, partition, title));
    return;
  }
  const std::vector<ErrorRegion>& where = models.front().comparison.where;
  report.section("Where it fails",
                 "Each chart splits the total squared error by region, in units of the noise floor. Where a region's "
                 "share of the error exceeds its share of the samples, the model lacks something there.");
  for (const auto& [partition, title] :
       {std::pair("regime", "By what the axis does"), std::pair("direction", "By direction"),
        std::pair("speed", "By speed"), std::pair("position", "By position along the travel"),
        std::pair("order", "What repeats along the travel (of the residual)"),
        std::pair("rest", "By time at rest before motion"), std::pair("frequency", "By frequency"),
        std::pair("time", "By time")})
    add(bars_of(where, partition, title));
}

}  // namespace

std::string comparison_text(std::span<const ComparedModel> models, const Terminal& terminal) {
  const ComparedModel& first = models.front();
  std::string text = terminal_verdict(verdict_of(models), terminal) + "\n";
  text += terminal_table(error_table(models), terminal);
  if (models.size() > 1) return text + "\n" + terminal_bars(overlaid_bars(models, "regime", "By regime"), terminal);
  if (first.comparison.relative_error)
    text += wrapped(fmt::format("\nThe inverse model leaves {} of the {} unexplained.{}",
                                percent(*first.comparison.relative_error),
                                first.model.data.kind == sim::DriveKind::rotary ? "torque" : "force",
                                has_inverse(sim::Drive(first.model))
                                    ? ""
                                    : " It omits effects without an inverse (second mass, lag, bristles)."),
                    terminal.columns) +
            "\n";
  for (const RecordError& record : first.comparison.records)
    if (record.free_run)
      text += fmt::format("Free run of {} from its first {} samples: position off by {:.3g} {} (RMS).\n",
                          file_name(record.path), kGivenSamples, *record.free_run,
                          first.model.data.kind == sim::DriveKind::rotary ? "mm" : "m");
  if (!first.comparison.table.empty())
    text += "\n" + wrapped(table_words(first.comparison.table), terminal.columns) + "\n";
  text +=
      "\n" + terminal_bars(bars_of(first.comparison.where, "regime", "Share of the squared error by regime"), terminal);
  Table regions;
  regions.title = "Where the error stands out";
  regions.headings = {"by", "region", "of the squared error", "of the samples", "error/floor"};
  constexpr std::size_t kMostRegions = 8;
  for (const ErrorRegion& region : outstanding(first.comparison.where, kMostRegions))
    regions.rows.push_back(
        {region.partition, region.region, percent(region.share), percent(region.portion), format_value(region.rms)});
  if (!regions.rows.empty()) text += "\n" + terminal_table(regions, terminal);
  return text;
}

Report comparison_report(std::span<const ComparedModel> models, const Focus& focus) {
  const ComparedModel& first = models.front();
  const ModelComparison& comparison = first.comparison;
  std::string names, titles;
  for (const RecordError& record : comparison.records) names += (names.empty() ? "" : ", ") + file_name(record.path);
  for (const ComparedModel& one : models) titles += (titles.empty() ? "" : ", ") + one.name();
  Report report(models.size() > 1 ? "Models and measurement" : "Model and measurement",
                fmt::format("{} · {}", titles, names));
  report.verdict(verdict_of(models));

  report.section("Measured and predicted");
  report.add(prediction_traces(models, record_in(focus, comparison), focus.stretch));
  report.section("Size of the error");
  if (models.size() == 1) {
    Facts facts;
    facts.items = {{"error over floor", format_value(comparison.error.combined)},
                   {"prediction window", fmt::format("{:g} s", comparison.error.window_s)}};
    if (comparison.relative_error)
      facts.items.emplace_back("inverse model's error", percent(*comparison.relative_error));
    std::string effects;
    for (const sim::EffectEntry& effect : first.model.effects) effects += (effects.empty() ? "" : ", ") + effect.kind;
    facts.items.emplace_back("effects in the model", effects);
    report.add(std::move(facts));
  }
  report.add(error_table(models));
  add_table_figures(comparison.table, report);
  add_missing_effort(models, report, focus);
  add_where_it_fails(models, report);
  return report;
}

}  // namespace host
