// The page: following error before and after, its cause, and the part that does not repeat; then the evidence.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "host/commission/following.hpp"
#include "host/commission/steps.hpp"
#include "host/compare/residual_figures.hpp"
#include "host/model/model_file.hpp"
#include "host/parameters/compensation_parameters.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/read_record.hpp"
#include "host/report/report.hpp"
#include "host/report/text_format.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

std::string title_of(const std::string& kind) {
  const sim::EffectInfo* info = sim::find_effect(kind);
  return info == nullptr ? kind : std::string(info->title);
}

struct Page {
  CommissionSession& session;
  const nlohmann::json& state;
  nlohmann::json errors, comparison, improvement;

  const nlohmann::json& sets() const { return errors["sets"]; }
  /// The set that is on the board; if the old one stayed, the last that was tried.
  const nlohmann::json& last() const {
    const auto kept = std::ranges::find_if(sets(), [&](const auto& set) { return set["name"] == errors["kept"]; });
    return is_new() && kept != sets().end() ? *kept : sets().back();
  }
  double before() const { return sets().front()["rms_um"]; }
  bool has_after() const { return !last()["rms_um"].is_null(); }
  double after() const { return has_after() ? last()["rms_um"].get<double>() : before(); }
  double not_repeatable() const { return errors["floor_um"]; }
  bool is_new() const { return state.value("kept", "") == "new"; }

  /// Effects of the improved model that the first one lacked.
  std::vector<std::string> added() const {
    std::vector<std::string> kinds;
    if (state.at("decided").is_array()) kinds = state.at("decided").get<std::vector<std::string>>();
    for (const auto& rung : improvement["ladder"])
      for (const auto& kind : rung["added"]) kinds.push_back(kind);
    return kinds;
  }

  /// Title of an effect, or of the group that these motions cannot separate from it.
  std::string alike(const std::string& kind) const {
    if (!state.at("decided").is_array())
      for (const auto& alternatives : state.at("verdict").at("alternatives")) {
        const auto group = alternatives.get<std::vector<std::string>>();
        if (std::ranges::find(group, kind) == group.end()) continue;
        std::vector<std::string> titles;
        for (const std::string& one : group) titles.push_back(title_of(one));
        return fmt::format("one of {}", fmt::join(titles, ", "));
      }
    return title_of(kind);
  }

  std::string cause() const {
    std::vector<std::string> titles;
    for (const std::string& kind : added()) titles.push_back(alike(kind));
    if (!titles.empty()) return fmt::format("{}", fmt::join(titles, " and "));
    const auto& verdict = state.at("verdict");
    const std::string status = verdict["status"];
    if (status == "adequate") return "nothing is missing in the model";
    if (status == "parameters")
      return fmt::format("wrong values: {}", fmt::join(verdict["parameters"].get<std::vector<std::string>>(), ", "));
    if (status == "ambiguous")
      return fmt::format("one of {}", fmt::join(verdict["effects"].get<std::vector<std::string>>(), ", "));
    if (status == "insufficient_data") return "none that these motions can show";
    return "no known effect";
  }
};

/// The result, for a reader who does not know this tool; the method follows below.
std::vector<std::string> findings(const Page& page) {
  const std::vector<std::string> kinds = page.added();
  if (kinds.empty()) return {page.state.at("verdict").at("explanation")};
  std::vector<std::string> sentences;
  for (const std::string& kind : kinds)
    if (const sim::EffectInfo* info = sim::find_effect(kind))
      sentences.push_back(fmt::format("{}: {}. Usual origin: {}.", info->title, info->shows, info->origin));
  sentences.push_back(
      fmt::format("The model's prediction error falls from {} to {} times the noise floor on validation data.",
                  format_value(page.comparison["combined"].get<double>()),
                  format_value(page.improvement["error"]["after"]["validate"]["combined"].get<double>())));
  return sentences;
}

/// Shares of the gain from the loop and from the model; empty if there was only one step.
std::string shares_of_gain(const Page& page) {
  if (page.errors["kept"] != "after" || page.sets()[1]["name"] != "loop" || page.sets()[1]["rms_um"].is_null())
    return {};
  const double tuned = page.sets()[1]["rms_um"];
  if (!(tuned < page.before()) || !(page.after() < tuned)) return {};
  return fmt::format("Of the gain of {} µm, the tuned loop contributes {} and the better model {}.",
                     format_value(page.before() - page.after()), format_value(page.before() - tuned),
                     format_value(tuned - page.after()));
}

Verdict verdict_of(const Page& page) {
  Verdict verdict;
  verdict.tone = page.is_new() ? Tone::good : Tone::neutral;
  verdict.label = page.is_new() ? "error reduced" : "no gain";
  verdict.headline =
      fmt::format("Following error: {} µm before, {}; {} µm do not repeat. Cause: {}.", format_value(page.before()),
                  page.has_after() ? format_value(page.after()) + " µm after" : "stopped by the new parameters",
                  format_value(page.not_repeatable()), page.cause());
  if (const std::string shares = shares_of_gain(page); !shares.empty()) verdict.sentences.push_back(shares);
  for (std::string& found : findings(page)) verdict.sentences.push_back(std::move(found));
  for (const auto& kind : page.errors["by_hand"]) {
    const std::string name = kind.get<std::string>();
    const sim::EffectInfo* info = sim::find_effect(name.substr(0, name.find_first_of(" :")));
    verdict.sentences.push_back(fmt::format("By hand: {}: {}.", info != nullptr ? std::string(info->title) : name,
                                            info != nullptr ? std::string(info->remedy) : "no parameter corrects it"));
  }
  for (const auto& kind : page.errors["needs_home"])
    verdict.sentences.push_back(fmt::format(
        "Compensation of {} needs homing: wire a switch or an index, and start again with --home.", title_of(kind)));
  verdict.sentences.push_back(
      fmt::format("The {} parameters are on the board{}", page.is_new() ? "new" : "old",
                  page.state.value("saved", false) ? " and saved." : ", until power-off. To keep them:"));
  if (!page.state.value("saved", false)) verdict.command = "axistool save";
  return verdict;
}

std::string set_title(const Page& page, const nlohmann::json& set) {
  if (set["name"] == "before")
    return page.state.value("was_fitted", false) ? "before: as the board was" : "before: base model";
  return set["what"];
}

BarChart errors_chart(const Page& page) {
  BarChart chart;
  chart.title = "Following error of this axis, RMS";
  chart.caption =
      "The same jogs, twice with each set of parameters; ±: difference between the two RMS values. Not repeatable: RMS "
      "of the difference between equal runs, which no parameter can reduce. N/µm: least stiffness against a process "
      "force. The base model has only inertia and friction.";
  chart.unit = "µm";
  chart.series = {{"RMS", SeriesRole::measured}};
  for (const auto& set : page.sets())
    if (!set["rms_um"].is_null())
      chart.rows.push_back({set_title(page, set),
                            {set["rms_um"].get<double>()},
                            fmt::format("± {} µm; {} N/µm{}", format_value(set["repeats_um"].get<double>(), 2),
                                        format_value(1.0 / set["compliance_um_N"].get<double>()),
                                        set["name"] == page.errors["kept"] ? ", kept"
                                        : set["too_soft"]                  ? ", too soft"
                                                                           : "")});
  chart.rows.push_back({"not repeatable", {page.not_repeatable()}, ""});
  return chart;
}

/// A record's following error as a residual over the travel.
ResidualEffort following_along(const Record& record, const sim::DataSheet& data) {
  const MovingRows rows = moving_rows(record);
  ResidualEffort samples;
  samples.missing = following_um(record, data);
  for (std::size_t k = rows.begin; k < rows.end; ++k) {
    samples.x.push_back(record.x[k]);
    samples.w.push_back(record.x[std::min(k + 1, rows.end - 1)] - record.x[k > rows.begin ? k - 1 : k]);
  }
  return samples;
}

void add_picture(Report& report, const Page& page, const std::vector<std::pair<std::string, std::string>>& runs) {
  const sim::DataSheet& data = page.session.options().sheet.data;
  const double period = ripple_period(read_model(page.session.folder().require("improved.toml", "improve")));
  std::vector<ResidualView> views;
  for (const auto& [file, name] : runs)
    views.push_back(
        {name, SeriesRole::residual, following_along(read_record(page.session.folder().path(file)), data), {}});
  add_residual_plot(report, coordinate_of("position", data.kind, period), "Along the travel", {"following error", "µm"},
                    views, &ResidualView::force, Layout::side_by_side);
}

/// "response-01.csv to response-09.csv" for consecutively numbered files.
std::string files_in_words(const std::vector<std::string>& files) {
  const auto stem_of = [](const std::string& file) {
    return file.substr(0, file.find_last_not_of("0123456789", file.rfind('.') - 1) + 1);
  };
  std::vector<std::string> words;
  for (std::size_t k = 0; k < files.size();) {
    std::size_t end = k + 1;
    const bool counts = files[k].rfind('.') != std::string::npos && stem_of(files[k]).size() < files[k].rfind('.');
    while (counts && end < files.size() && stem_of(files[end]) == stem_of(files[k])) ++end;
    words.push_back(end > k + 2 ? fmt::format("{} to {}", files[k], files[end - 1]) : files[k]);
    k = end > k + 2 ? end : k + 1;
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

Table steps_table(const Page& page) {
  Table table;
  table.title = "Steps and their files";
  table.headings = {"step", "found", "files"};
  table.stacks = true;
  const std::string explanation = page.state.at("verdict").at("explanation");
  for (const auto& step : page.state["steps"]) {
    if (!step.value("done", false)) continue;
    std::string said = step.value("said", "");
    // The explanation is at the top, or on the page of the diagnosis.
    if (const std::size_t at = said.find(explanation); !explanation.empty() && at != std::string::npos)
      said.erase(at, explanation.size());
    if (step["name"] == "estimator" && page.state.value("estimator", nlohmann::json()).is_object())
      said = "The tests are described above.";
    if (step["name"] == "compensate" && page.is_new() && page.has_after()) said = "The figures are above.";
    table.rows.push_back({step["name"], said, files_in_words(step["files"].get<std::vector<std::string>>())});
  }
  return table;
}

ScatterPlot estimator_plot(const nlohmann::json& tests) {
  ScatterPlot plot;
  const bool has_force = tests["force_N"].is_number();
  plot.title = "Deviation against noise of the command";
  plot.caption =
      "A point for each disturbance variance Rwd, which grows along the line. The deviation is the following error" +
      (has_force ? fmt::format(" and the response to a force of {:g} N at the softest frequency.",
                               tests["force_N"].get<double>())
                 : std::string("; a process force is not known."));
  plot.x = {"noise of the command", "mV"};
  plot.y = {"deviation, RMS", "µm"};
  plot.logarithmic_x = plot.logarithmic_y = true;
  ScatterSeries tried{"tried", SeriesRole::measured, SeriesStyle::line_and_points, {}, {}, {}, {}},
      chosen{"chosen", SeriesRole::after, SeriesStyle::points, {}, {}, {}, {}};
  for (const auto& test : tests["tried"]) {
    if (test["rms_um"].is_null()) continue;
    const bool is_chosen = test["rwd_V2"] == tests["chosen_V2"];
    for (ScatterSeries* series : {&tried, &chosen}) {
      if (series == &chosen && !is_chosen) continue;
      const double error_um = test["deviation_um"], half_um = test["repeats_um"].get<double>() / 2.0;
      series->x.push_back(1e3 * test["command_noise_V"].get<double>());
      series->y.push_back(error_um);
      series->lower.push_back(error_um - half_um);
      series->upper.push_back(error_um + half_um);
    }
  }
  plot.series = {tried, chosen};
  return plot;
}

Table estimator_table(const nlohmann::json& tests) {
  Table table;
  table.title = "Disturbance variances that were tried";
  table.headings = {"Rwd, V²",        "estimator, Hz",       "loop, Hz",
                    "modulus margin", "following error, µm", "stiffness, N/µm",
                    "softest at, Hz", "noise, mV",           ""};
  const auto shown = [](const nlohmann::json& figure, double factor) {
    return figure.is_null() ? "–" : format_value(factor * figure.get<double>());
  };
  for (const auto& test : tests["tried"]) {
    const bool is_run = !test["rms_um"].is_null(), is_designed = test["bandwidth_Hz"] != 0.0;
    table.rows.push_back({fmt::format("{:g}", test["rwd_V2"].get<double>()),
                          is_designed ? shown(test["observer_Hz"], 1.0) : "–",
                          is_designed ? shown(test["bandwidth_Hz"], 1.0) : "–", shown(test["modulus"], 1.0),
                          is_run ? fmt::format("{} ± {}", shown(test["rms_um"], 1.0),
                                               format_value(test["repeats_um"].get<double>() / 2.0, 2))
                                 : "–",
                          is_designed ? format_value(1.0 / test["compliance_um_N"].get<double>()) : "–",
                          shown(test["softest_at_Hz"], 1.0), shown(test["command_noise_V"], 1e3),
                          test["rwd_V2"] == tests["chosen_V2"] ? "chosen"
                          : is_run                             ? ""
                          : is_designed                        ? "stopped by a fault"
                                                               : "no margin"});
  }
  return table;
}

Table tachometer_table(const nlohmann::json& variance, sim::DriveKind kind) {
  Table table;
  table.title = "The tachometer's own noise";
  table.caption = "Rw is the larger of both variances, because the noise changes between measurements.";
  table.headings = {"state of the axis", fmt::format("variance, ({})²", units_of(kind).speed), "records"};
  const nlohmann::json from = variance.value("from", nlohmann::json::object());
  for (const auto& [key, state] : {std::pair{"at_rest", "at rest"}, {"moving", "in motion"}}) {
    const nlohmann::json& value = variance[key];
    table.rows.push_back({state, value.is_null() ? "–" : format_value(value.get<double>()),
                          files_in_words(from.value(key, std::vector<std::string>{}))});
  }
  table.rows.push_back({"used as Rw", format_value(variance["used"].get<double>()), ""});
  return table;
}

void add_estimator(Report& report, const Page& page) {
  if (!page.state.value("estimator", nlohmann::json()).is_object()) return;
  const nlohmann::json tests = page.session.folder().read_json("estimator.json");
  report.section(
      "How fast the estimator may be",
      tests["why"].get<std::string>() +
          ". A larger Rwd makes the estimate of the disturbance faster, so that process forces move the axis "
          "less, and the command noisier (Erkorkmaz & Altintas 2001, p. 1503). Stiffness: least force on the "
          "table per amplitude of the position, over the measured frequencies. At a given margin, noise grows "
          "about as fast as stiffness, so these two alone favour no value. " +
          (tests["force_N"].is_number()
               ? "The given force decides: the calmest value with the least deviation under it. "
               : "No process force was given (--force), so no value may make the axis softer than the first "
                 "estimator does; of the others, the calmest one with the least following error. ") +
          "These runs have the whole controller of the better model; estimator.json states why a value was "
          "not run. " +
          (page.state.value("estimator_kept", false)
               ? "In the last comparison it gained: it is on the board."
               : "In the last comparison it gained nothing, or made the axis softer: it is not on the board."));
  report.add(estimator_plot(tests));
  report.add(estimator_table(tests));
  if (tests.contains("tachometer_variance"))
    report.add(tachometer_table(tests["tachometer_variance"], page.session.options().sheet.data.kind));
}

Table pages_table(const Page& page) {
  Table table;
  table.title = "In detail";
  table.headings = {"page", "what it shows"};
  for (const auto& [file, shows] :
       {std::pair{"improvement.html", "the residual before and after, along speed, travel and time"},
        {"diagnosis.html", "every effect tried, and how much each explains"},
        {"response.html", "the measured frequency response, and the loop designed from it"}}) {
    if (!page.session.folder().has(file)) continue;
    table.rows.push_back({file, shows});
    table.links.emplace_back(file);
  }
  return table;
}

}  // namespace

CommissionStepResult write_page(CommissionSession& session) {
  CommissionFolder& folder = session.folder();
  folder.require("errors.json", "compensate");
  const Page page{session, folder.document(), folder.read_json("errors.json"), folder.read_json("comparison.json"),
                  folder.read_json("improvement.json")};
  Report report("Axis " + session.options().axis_name,
                session.options().sheet.name.empty() ? "commissioning" : session.options().sheet.name);
  report.verdict(verdict_of(page));
  report.section("Before and after, on the machine");
  report.add(errors_chart(page));
  std::vector<std::pair<std::string, std::string>> runs{{"before.csv", "before"}};
  if (page.has_after()) runs.emplace_back(page.last()["record"], "after");
  add_picture(report, page, runs);
  add_estimator(report, page);
  report.section("How it was found");
  report.add(pages_table(page));
  report.add(steps_table(page));
  report.write(folder.path("page.html"));
  folder.put("page", folder.path("page.html"));
  return {{"page.html"}, "Written."};
}

}  // namespace host
