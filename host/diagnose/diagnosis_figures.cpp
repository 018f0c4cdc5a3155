#include "host/diagnose/diagnosis_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/compare/residual_figures.hpp"
#include "host/compare/residual_spectrum.hpp"
#include "host/diagnose/all_clear.hpp"
#include "host/diagnose/claim.hpp"
#include "host/record/drive_units.hpp"
#include "host/report/text_format.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// The period of the model's ripples; without one, that of the most probable candidate that has a period; without one,
/// a turn of the shaft.
double period_of(const sim::DriveDescription& model, const Diagnosis& diagnosis) {
  const auto has_period = [](const sim::EffectEntry& entry) { return entry.has("period"); };
  if (std::ranges::none_of(model.effects, has_period))
    for (const JudgedCandidate& candidate : diagnosis.candidates)
      if (const sim::EffectEntry& main = *candidate.model.find(candidate.kinds.back()); has_period(main))
        return main.at("period");
  return ripple_period(model);
}

std::vector<std::string> titles_of(const std::vector<std::string>& kinds) {
  std::vector<std::string> titles;
  for (const std::string& kind : kinds) titles.emplace_back(sim::find_effect(kind)->title);
  return titles;
}

}  // namespace

void add_found(Report& report, const std::vector<FoundEffect>& found, bool rivals) {
  if (found.empty()) return;
  report.section(rivals ? "Possible explanations" : "What was found",
                 rivals ? "These records cannot tell these effects apart." : "");
  for (const FoundEffect& effect : found) {
    report.add(effect_plot(effect));
    if (effect.points && effect.points->is_record()) report.add(effect.points->context);
  }
}

void add_unexplained(Report& report, const Diagnosis& diagnosis) {
  const std::string& coordinate = diagnosis.verdict.coordinate;
  if (coordinate.empty()) return;
  const sim::DriveKind kind = diagnosis.best.data.kind;
  const bool of_speed_channel = speed_channel_alone_fails(diagnosis);
  const RecordSet all = together(diagnosis.training, diagnosis.validation);
  if (coordinate == "frequency") {
    const ResidualView view{"", SeriesRole::residual, residuals_on({&diagnosis.best}, all).front(), {}};
    report.section("What is left", fmt::format("Unexplained residual, most of it {}.", diagnosis.verdict.where));
    return add_residual_spectrum(report, {&view, 1}, kind);
  }
  const ResidualEffort samples =
      of_speed_channel ? residual_of_speed_channel(diagnosis.best, all) : residuals_on({&diagnosis.best}, all).front();
  const ResidualCoordinate over = coordinate_of(coordinate, kind, period_of(diagnosis.best, diagnosis));
  if ((samples.*over.along).size() != samples.w.size() || samples.w.empty()) return;
  ScatterPlot plot;
  plot.title = fmt::format("Unexplained residual against {}", over.axis.quantity);
  plot.caption = fmt::format("Residual on training and validation data, most of it {}.", diagnosis.verdict.where);
  plot.large = true;
  plot.x = over.axis;
  plot.y = {of_speed_channel                 ? "speed residual"
            : kind == sim::DriveKind::rotary ? "torque residual"
                                             : "force residual",
            of_speed_channel ? units_of(kind).speed : units_of(kind).effort};
  plot.logarithmic_x = over.logarithmic;
  for (ScatterSeries& curve : direction_curves(samples, samples.missing, over))
    if (!curve.x.empty()) plot.series.push_back(std::move(curve));
  if (plot.series.empty()) return;
  show_means(plot);
  report.section("What is left");
  report.add(std::move(plot));
}

std::vector<std::string> remedies(const std::vector<std::string>& kinds) {
  std::vector<std::string> sentences;
  for (const std::string& kind : kinds) {
    const sim::EffectInfo& info = *sim::find_effect(kind);
    if (!info.remedy.empty()) sentences.push_back(fmt::format("{}, what to do: {}.", info.title, info.remedy));
  }
  return sentences;
}

namespace {

/// A channel's column in the table, in the units of its error.
struct ShownChannel {
  const char *quantity, *unit;
  double factor;
};

ShownChannel shown_channel(const std::string& column) {
  if (column == "x_mm") return {"position", "µm", 1e3};
  if (column == "x_m") return {"position", "µm", 1e6};
  if (column == "v_m_s") return {"speed", "mm/s", 1e3};
  if (column == "effort_Nm") return {"torque", "Nm", 1.0};
  if (column == "effort_N") return {"force", "N", 1.0};
  return {"speed", "rad/s", 1.0};
}

std::string change_in_percent(const ChannelError& channel) {
  return fmt::format("{:+.0f} %", 100.0 * (channel.after_validate / channel.before_validate - 1.0));
}

}  // namespace

std::vector<ChannelError> channel_errors(const ErrorFigures& before, const ErrorFigures& after,
                                         const std::optional<EffortError>& effort) {
  std::vector<ChannelError> channels;
  for (const ChannelFigures& channel : after.channels)
    if (const auto same = std::ranges::find(before.channels, channel.name, &ChannelFigures::name);
        same != before.channels.end())
      channels.push_back({channel.name, same->rms, channel.rms, channel.floor});
  if (effort)
    channels.push_back({effort->name, effort->before_validate, effort->after_validate, effort->floor_validate});
  return channels;
}

Table error_table(const std::vector<ChannelError>& channels, bool added) {
  Table table;
  table.title = "Error on validation data";
  table.caption = "RMS of the prediction error.";
  table.headings = added ? std::vector<std::string>{"channel", "before", "after", "change", "noise floor"}
                         : std::vector<std::string>{"channel", "error", "noise floor"};
  for (const ChannelError& channel : channels) {
    const ShownChannel shown = shown_channel(channel.name);
    const auto text = [&](double value) { return format_value(shown.factor * value) + " " + shown.unit; };
    std::vector<std::string> row{shown.quantity, text(channel.before_validate)};
    if (added) {
      row.push_back(text(channel.after_validate));
      row.push_back(change_in_percent(channel));
    }
    row.push_back(text(channel.floor_validate));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string errors_in_words(const std::vector<ChannelError>& channels) {
  std::vector<std::string> words;
  for (const ChannelError& channel : channels) {
    if (!(channel.before_validate > 0.0)) continue;
    const ShownChannel shown = shown_channel(channel.name);
    words.push_back(
        fmt::format("{} error {} → {} {} ({})", shown.quantity, format_value(shown.factor * channel.before_validate),
                    format_value(shown.factor * channel.after_validate), shown.unit, change_in_percent(channel)));
  }
  return words.empty() ? "" : fmt::format("On validation data: {}.", fmt::join(words, ", "));
}

void add_residuals(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best, bool added) {
  const RecordSet& set = diagnosis.validation;
  std::vector<ResidualEffort> residuals = residuals_on({&diagnosis.base, &best}, set);
  std::vector<ResidualView> views{{added ? "before" : "", SeriesRole::before, std::move(residuals.front()),
                                   residual_of_speed_channel(diagnosis.base, set)}};
  if (added)
    views.push_back({"after", SeriesRole::after, std::move(residuals.back()), residual_of_speed_channel(best, set)});
  if (views.front().force.w.empty()) return;
  const double period = period_of(best, diagnosis);
  report.section(added ? "Residual before and after" : "Residual",
                 "Residual on validation data: mean in bins with the band that holds 80 % of the samples, forward and "
                 "backward separately. A complete model gives a flat line at zero. The line breaks where there are no "
                 "samples; the strip below shows their number.");
  add_residual_maps(report, views, coordinate_of("position", best.data.kind, period),
                    coordinate_of("speed", best.data.kind), best.data.kind);
  add_residual_plots(report, views, best, period, Layout::side_by_side);
}

namespace {

ScatterPlot correlation_plot(const std::string& title, const std::string& caption, const Correlation& correlation) {
  ScatterPlot plot{title, caption, {"lag", "ms"}, {"correlation", ""}, {}};
  std::vector<double> lag_ms;
  for (const double lag_s : correlation.lag_s) lag_ms.push_back(1e3 * lag_s);
  const std::vector<double> zero(lag_ms.size(), 0.0), bound(lag_ms.size(), correlation.bound),
      below(lag_ms.size(), -correlation.bound);
  plot.series = {{"99 % of a white residual", SeriesRole::floor, SeriesStyle::line, lag_ms, zero, below, bound},
                 {"correlation", SeriesRole::residual, SeriesStyle::stems, lag_ms, correlation.value, {}, {}}};
  return plot;
}

}  // namespace

void add_whiteness(Report& report, const Diagnosis& diagnosis) {
  const ResidualTests& tests = diagnosis.residual;
  if (tests.dependences.empty()) return;
  report.section("Is the residual noise?",
                 "Autocorrelation of the residual on validation data. Within the bounds it is white noise. The model "
                 "of a real machine may exceed them, so the verdict measures how much of the residual depends on a "
                 "coordinate, and confirms that on held-back data.");
  report.add(correlation_plot("Correlation with itself",
                              "The first 20 ms show the smoother that computes the residual.", tests.with_itself));
  report.add(
      correlation_plot("Correlation with the command",
                       "Positive lags: correlation with earlier commands. A delay, a lag or a resonance shows there.",
                       tests.with_command));
  Table table;
  table.title = "What it depends on";
  table.headings = {"coordinate", "of the squared residual", "most"};
  for (const ResidualDependence& dependence : tests.dependences)
    table.rows.push_back(
        {spaced(dependence.coordinate), fmt::format("{:.1f} %", 100.0 * dependence.share), dependence.where});
  report.add(table);
}

void add_traces(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best, bool added) {
  const DriveUnits units = units_of(best.data.kind);
  const ComparedRecord& compared = diagnosis.validation.records.front();
  const Record& record = *compared.prepared.record;
  Prediction before, after;
  predict(sim::Drive(diagnosis.base), compared.prepared, before);
  predict(sim::Drive(best), compared.prepared, after);
  // There is no prediction between the windows or before the first one.
  const auto shown = [&](const std::vector<double>& predicted, const std::vector<double>* less) {
    std::vector<double> values(record.size(), std::nan(""));
    for (const Window& window : compared.prepared.windows)
      for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
        values[k] = less == nullptr ? predicted[k] : (*less)[k] - predicted[k];
    return values;
  };
  const auto errors = [&](const std::vector<double>& first, const std::vector<double>& last,
                          const std::vector<double>& measured, double factor) {
    const auto in_unit = [factor](std::vector<double> values) {
      for (double& value : values) value *= factor;
      return values;
    };
    if (!added) return std::vector<TimeTrace>{{"error", SeriesRole::residual, in_unit(shown(first, &measured))}};
    return std::vector<TimeTrace>{{"before", SeriesRole::before, in_unit(shown(first, &measured))},
                                  {"after", SeriesRole::after, in_unit(shown(last, &measured))}};
  };
  TimePlot plot;
  plot.title = "Measured and predicted";
  plot.caption = fmt::format("The prediction uses only the command and restarts from the measurement every {:g} s.",
                             diagnosis.window_s);
  plot.t_s = record.t_s;
  if (record.has_speed()) {
    plot.panels.push_back({"speed",
                           units.speed,
                           {{"measured", SeriesRole::measured, record.w},
                            {"predicted", SeriesRole::predicted, shown(after.w, nullptr)}}});
    plot.panels.push_back({"speed error", units.speed, errors(before.w, after.w, record.w, 1.0)});
  }
  if (record.has_position())
    plot.panels.push_back(
        {"position error", "µm", errors(before.x, after.x, record.x, 1e3 * travel_in_mm(best.data.kind))});
  report.section("Measured and predicted", fmt::format("Validation record {}.", record.path));
  report.add(plot);
}

namespace {

/// Whether it lowers the error on both sets by at least kLeastGain.
bool changes_something(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  return candidate.after < (1.0 - kLeastGain) * candidate.before &&
         candidate.train_after < (1.0 - kLeastGain) * diagnosis.before_train;
}

/// Whether the verdict names it, or lists it among the effects that these records cannot tell from a named one.
bool is_named(const JudgedCandidate& candidate, const DiagnosisVerdict& verdict) {
  if (verdict.effects.empty()) return false;
  return std::ranges::all_of(candidate.kinds, [&](const std::string& kind) {
    return std::ranges::find(verdict.effects, kind) != verdict.effects.end() ||
           std::ranges::any_of(verdict.alternatives, [&](const std::vector<std::string>& group) {
             return std::ranges::find(group, kind) != group.end();
           });
  });
}

/// Number of effects that the verdict names. Of a group of rivals, only one counts.
std::size_t chosen_size(const DiagnosisVerdict& verdict) {
  return verdict.status == Status::ambiguous ? 1 : verdict.effects.size();
}

BarChart chart_of(const std::string& title, const std::string& caption) {
  BarChart chart;
  chart.title = title;
  chart.caption = caption;
  chart.series = {{"without", SeriesRole::before}, {"with", SeriesRole::after}};
  chart.reference = {"noise floor", 1.0};
  return chart;
}

}  // namespace

void add_candidates(Report& report, const Diagnosis& diagnosis) {
  const DiagnosisVerdict& verdict = diagnosis.verdict;
  const bool tied = !verdict.alternatives.empty();
  BarChart named = chart_of(
      tied ? "These records cannot tell these apart" : "What explains the error",
      "Error on validation data in multiples of the noise floor, all parameters fitted again; shorter is better.");
  BarChart others = chart_of("Other effects that lower the error", "");
  BarChart rest = chart_of("", "They lower the error on training or validation data by less than 5 %.");
  constexpr std::size_t kMostOthers = 8;
  for (const JudgedCandidate& candidate : diagnosis.candidates) {
    BarChart& chart = is_named(candidate, verdict) && candidate.kinds.size() == chosen_size(verdict) ? named
                      : changes_something(candidate, diagnosis)                                      ? others
                                                                                                     : rest;
    if (&chart == &others && others.rows.size() == kMostOthers) continue;
    chart.rows.push_back({fmt::format("{}", fmt::join(titles_of(candidate.kinds), " + ")),
                          {diagnosis.printed_base().validate, Diagnosis::printed(candidate).validate},
                          fmt::format("{:.0f} % probable", 100.0 * candidate.probability)});
  }
  if (rest.rows.size() == 1) rest.title = "One tried effect makes no difference";
  if (rest.rows.size() > 1) rest.title = fmt::format("{} tried effects make no difference", rest.rows.size());
  rest.folded = true;
  for (BarChart* chart : {&named, &others, &rest})
    if (!chart->rows.empty()) report.add(std::move(*chart));
}

}  // namespace host
