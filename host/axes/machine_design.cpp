#include "host/axes/machine_design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "host/exit_codes.hpp"
#include "host/identify/design_json.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/design_file.hpp"

namespace host {

namespace {

constexpr std::array kFeeds_mm_s = {25.0, 50.0, 100.0, 200.0};

double unit_mm(const sim::DriveDescription& model) { return model.data.kind == sim::DriveKind::linear ? 1e3 : 1.0; }

void check(const std::vector<AxisTask>& tasks) {
  std::set<std::string> names;
  const double period_s = tasks.front().model.data.sample_period_s;
  for (const AxisTask& task : tasks) {
    if (!names.insert(task.model.name).second || task.model.name.empty())
      throw Failure(ExitCode::usage,
                    fmt::format("two axes are called \"{}\": give each model the name of its axis (name = \"x\")",
                                task.model.name));
    if (task.model.data.sample_period_s != period_s)
      throw Failure(
          ExitCode::usage,
          fmt::format(
              "axis {} is sampled every {:g} s, axis {} every {:g} s: all axes of a board share one sample_period_s",
              tasks.front().model.name, period_s, task.model.name, task.model.data.sample_period_s));
  }
}

FinePlant drive_of(const AxisTask& task) {
  return task.measured ? fine_plant(task.measured->response, *task.measured->fit) : fine_plant(plant_of(task.model));
}

/// Removes all tachometers if one axis has none, because all estimators must have the same sensors.
std::vector<sim::DriveDescription> equal_sensors(const std::vector<AxisTask>& tasks) {
  std::vector<sim::DriveDescription> models;
  bool all = true;
  for (const AxisTask& task : tasks) {
    models.push_back(task.model);
    all = all && task.model.data.tach_noise_variance.has_value();
  }
  if (!all)
    for (sim::DriveDescription& model : models) model.data.tach_noise_variance.reset();
  return models;
}

DesignOptions options_of(const AxisTask& task, DesignOptions options) {
  if (task.disturbance_variance) options.disturbance_variance = *task.disturbance_variance;
  if (task.tach_variance) options.tach_variance = task.tach_variance;
  return options;
}

/// Variances that make all estimators equal in travel, speed and acceleration of the table: the noise of the worst
/// sensors, and disturbances that accelerate the table like those of the axis on which they accelerate it least.
std::vector<DesignOptions> equal_estimators(const std::vector<sim::DriveDescription>& models,
                                            const std::vector<DesignOptions>& own) {
  std::vector<AxisDesign> designs;
  double least_gain = HUGE_VAL, position = 0.0, speed = 0.0, command = 0.0, disturbance = HUGE_VAL;
  const auto gain = [&](std::size_t i) { return designs[i].axis.gain() * designs[i].axis.lead * unit_mm(models[i]); };
  for (std::size_t i = 0; i < models.size(); ++i) {
    designs.push_back(design_axis(models[i], own[i]));
    const DesignOptions& used = designs[i].used;
    const double length = unit_mm(models[i]), lead = designs[i].axis.lead * length;
    position = std::max(position, *used.position_variance * length * length);
    speed = std::max(speed, used.tach_variance.value_or(0.0) * lead * lead);
    disturbance = std::min(disturbance, used.disturbance_variance * gain(i) * gain(i));
    if (gain(i) < least_gain) {
      least_gain = gain(i);
      command = *used.command_variance;
    }
  }
  std::vector<DesignOptions> list;
  for (std::size_t i = 0; i < models.size(); ++i) {
    DesignOptions one = own[i];
    const double length = unit_mm(models[i]), lead = designs[i].axis.lead * length;
    one.disturbance_variance = disturbance / (gain(i) * gain(i));
    one.command_variance = command * std::pow(least_gain / gain(i), 2);
    one.position_variance = position / (length * length);
    if (designs[i].used.tach_variance) one.tach_variance = speed / (lead * lead);
    list.push_back(one);
  }
  return list;
}

/// Feed-forward of the reference velocity alone ignores viscous friction, which differs between axes. Viscous friction
/// is therefore fed forward as friction, so that every loop is that of a double integrator.
std::vector<sim::DriveDescription> equal_drives(std::vector<sim::DriveDescription> models,
                                                const DesignOptions& options) {
  if (!options.zero_phase)
    for (sim::DriveDescription& model : models)
      std::erase_if(model.effects, [](const sim::EffectEntry& effect) { return effect.kind == "viscous"; });
  return models;
}

/// `controlled`: the drive in the controller's units.
AxisLoop loop_of(const sim::DriveDescription& model, const sim::DriveDescription& controlled, DesignOptions options,
                 double bandwidth_Hz, const ControlFilterChoice& filters, const FinePlant& drive) {
  options.bandwidth_Hz = bandwidth_Hz;
  AxisLoop loop{model, design_axis(controlled, options), filters, {}, {}};
  const LoopMargins margins = quick_margins(drive, AxisController(designed_parameters(model, loop.design, filters)));
  if (!margins.is_stable)
    throw Failure(ExitCode::refused,
                  fmt::format("axis {} would oscillate with poles at {:.4g} Hz; nothing was written. --margin 0.5 "
                              "finds the highest bandwidth with this modulus margin on all axes",
                              model.name, bandwidth_Hz));
  if (margins.modulus) loop.modulus = margins.modulus->value;
  return loop;
}

std::vector<ControlFilterChoice> choices_for(const std::vector<AxisTask>& tasks, const LoopAim& aim) {
  std::vector<ControlFilterChoice> all = {aim.filters};
  if (!aim.seek_notch) return all;
  for (const AxisTask& task : tasks) {
    const PlantFit fit = task.measured ? *task.measured->fit : plant_of(task.model);
    const auto more = filter_choices(aim, fit, task.model.data.sample_period_s);
    all.insert(all.end(), more.begin() + 1, more.end());
  }
  return all;
}

struct Found {
  HighestLoop loop;
  ControlFilterChoice filters;
};

/// The highest common bandwidth of all drives, with the filters that allow it; without requirements, the bandwidth of
/// `options`.
Found best_loop(const std::vector<LoopTask>& drives, const std::vector<AxisTask>& tasks, const LoopAim& aim,
                const DesignOptions& options) {
  if (!aim.modulus && !aim.crossover_Hz) return {{options.bandwidth_Hz, 0.0, {}}, aim.filters};
  Found best{{}, aim.filters};
  for (const ControlFilterChoice& filters : choices_for(tasks, aim)) {
    const HighestLoop loop = highest_bandwidth(drives, aim, filters);
    const double most = std::max(best.loop.best_modulus, loop.best_modulus);
    if (loop.bandwidth_Hz > best.loop.bandwidth_Hz) best = {loop, filters};
    best.loop.best_modulus = most;
  }
  if (best.loop.bandwidth_Hz == 0.0)
    throw Failure(ExitCode::refused,
                  fmt::format("no bandwidth reaches this on {}: the largest modulus margin is {:.3g}",
                              drives.size() > 1 ? "all axes" : drives.front().model.name, best.loop.best_modulus));
  return best;
}

void forecast(LoopSet& set, const std::vector<AxisTask>& tasks) {
  std::vector<ServoAxis> axes;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const AxisLoop& loop = set.axes[i];
    axes.push_back({tasks[i].measured ? *tasks[i].measured->fit : plant_of(tasks[i].model),
                    AxisController(designed_parameters(loop.model, loop.design, loop.filters))});
  }
  const ReferenceLimits limits;
  double most = -1.0;
  for (const double feed : kFeeds_mm_s) {
    FeedContour worst{feed, 0.0, 0.0};
    for (std::size_t i = 0; i < axes.size(); ++i)
      for (std::size_t j = i + 1; j < axes.size(); ++j) {
        const FeedContour pair = contour_forecast(axes[i], axes[j], feed, limits);
        worst.line_45_um = std::max(worst.line_45_um, pair.line_45_um);
        worst.ellipse_um = std::max(worst.ellipse_um, pair.ellipse_um);
        if (feed != kFeeds_mm_s.back() || pair.line_45_um <= most) continue;
        most = pair.line_45_um;
        set.remaining = main_difference(axes[i], axes[j], feed, limits);
      }
    set.contour.push_back(worst);
  }
}

void limit(LoopSet& set, const std::vector<AxisTask>& tasks, LimitWishes wishes) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    AxisLoop& loop = set.axes[i];
    wishes.loop_Hz = loop.design.used.bandwidth_Hz;
    wishes.measured_Hz = tasks[i].measured ? lowest_resonance_Hz(*tasks[i].measured->fit) : std::nullopt;
    loop.limits = drive_limits(loop.model, wishes);
  }
}

/// Why an axis limits the matched loop below its own bandwidth: the common filters, if its own ones would allow more,
/// otherwise the common estimator.
std::string shared_cause(const LoopTask& task, const AxisLoop& own, const LoopAim& aim, double matched_Hz) {
  const bool by_filters = highest_bandwidth({task}, aim, own.filters).bandwidth_Hz > matched_Hz;
  return fmt::format("with the {} of all axes; its own loop reaches {:.3g} Hz", by_filters ? "filters" : "estimator",
                     own.design.used.bandwidth_Hz);
}

std::string reason(const std::vector<LoopTask>& drives, const std::vector<AxisLoop>& own, const Found& found,
                   const LoopAim& aim) {
  constexpr double kFaster = 1.05;  // beyond the step of the search
  const double matched_Hz = found.loop.bandwidth_Hz;
  if (!aim.modulus && !aim.crossover_Hz) return fmt::format("--fc {:g} Hz, as asked", matched_Hz);
  if (found.loop.stopped_by.empty()) return "the control rate: pole placement on a rigid drive is good for 0.12 of it";
  std::vector<std::string> names, shared;
  for (const std::size_t i : found.loop.stopped_by) {
    names.push_back(drives[i].model.name);
    if (own[i].design.used.bandwidth_Hz > kFaster * matched_Hz)
      shared.push_back(shared_cause(drives[i], own[i], aim, matched_Hz));
  }
  const bool is_one = names.size() == 1;
  const std::string limit = aim.modulus ? fmt::format("a modulus margin of {:g}", *aim.modulus)
                                        : fmt::format("a crossover of {:g} Hz", *aim.crossover_Hz);
  const std::string said = fmt::format("{} {}, which {} {} no further", is_one ? "axis" : "axes",
                                       fmt::join(names, " and "), is_one ? "keeps" : "keep", limit);
  if (shared.size() < names.size()) return said;
  return said + (is_one ? " " + shared.front() : " with the filters or the estimator of all axes");
}

nlohmann::json set_json(const LoopSet& set) {
  nlohmann::json axes = nlohmann::json::array(), contour = nlohmann::json::array();
  for (const AxisLoop& loop : set.axes) {
    nlohmann::json axis = design_json(loop.design);
    axis["name"] = loop.model.name;
    axis["filters"] = filter_json(loop.filters);
    axis["limits"] = drive_limits_json(loop.limits);
    axis["modulus"] = loop.modulus ? nlohmann::json(*loop.modulus) : nlohmann::json(nullptr);
    axes.push_back(axis);
  }
  for (const FeedContour& one : set.contour)
    contour.push_back({{"feed_mm_s", one.feed_mm_s}, {"line_45_um", one.line_45_um}, {"ellipse_um", one.ellipse_um}});
  return {{"axes", axes}, {"contour", contour}, {"remaining", set.remaining}};
}

}  // namespace

MachineDesign design_machine(const std::vector<AxisTask>& tasks, const DesignOptions& options, const LoopAim& aim,
                             const LimitWishes& limits) {
  check(tasks);
  const std::vector<sim::DriveDescription> models = equal_sensors(tasks);
  const std::vector<sim::DriveDescription> controlled = equal_drives(models, options);
  std::vector<DesignOptions> own;
  for (const AxisTask& task : tasks) own.push_back(options_of(task, options));
  const std::vector<DesignOptions> equal = equal_estimators(controlled, own);
  std::vector<FinePlant> drives;
  for (const AxisTask& task : tasks) drives.push_back(drive_of(task));

  MachineDesign machine;
  std::vector<LoopTask> all;
  for (std::size_t i = 0; i < tasks.size(); ++i) all.push_back({controlled[i], equal[i], drives[i]});
  const Found common = best_loop(all, tasks, aim, options);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    machine.matched.axes.push_back(
        loop_of(models[i], controlled[i], equal[i], common.loop.bandwidth_Hz, common.filters, drives[i]));
    const Found best = best_loop({{tasks[i].model, own[i], drives[i]}}, {tasks[i]}, aim, own[i]);
    machine.own.axes.push_back(
        loop_of(tasks[i].model, tasks[i].model, own[i], best.loop.bandwidth_Hz, best.filters, drives[i]));
  }
  machine.limited_by = reason(all, machine.own.axes, common, aim);
  for (LoopSet* set : {&machine.matched, &machine.own}) {
    limit(*set, tasks, limits);
    forecast(*set, tasks);
  }
  return machine;
}

nlohmann::json machine_json(const MachineDesign& machine) {
  return {{"format", "axis-machine-design/1"},
          {"matched", set_json(machine.matched)},
          {"own", set_json(machine.own)},
          {"limited_by", machine.limited_by},
          {"circle_radius_mm", kForecastRadius_mm}};
}

}  // namespace host
