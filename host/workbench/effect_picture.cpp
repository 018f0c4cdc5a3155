#include "host/workbench/effect_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "host/compare/residual_figures.hpp"
#include "host/diagnose/found_effect.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/report/effect_pages.hpp"
#include "host/statistics.hpp"
#include "sim/plant.hpp"

namespace host::workbench {

namespace {

constexpr double kMissing = 0.2;      ///< relative error of inertia and friction parameters
constexpr double kScale_mm = 0.0001;  ///< resolution of the scale on the table

/// Values that replace the catalogue's examples, so that the effect acts within the run or is clearly visible.
struct OtherValue {
  std::string_view kind, id;
  double value;
};
constexpr std::array kOtherValues{OtherValue{"current_saturation", "limit", 8.0},
                                  OtherValue{"voltage_limit", "stall", 12.0},
                                  OtherValue{"external_torque", "start", 6.0},
                                  OtherValue{"external_torque", "duration", 2.0},
                                  OtherValue{"thermal_friction_drift", "time_constant", 5.0},
                                  OtherValue{"thermal_growth", "time_constant", 5.0},
                                  OtherValue{"spring_torque", "stiffness", 0.02},
                                  OtherValue{"cogging", "cosine", 0.15},
                                  OtherValue{"position_dependent_friction", "cosine", 0.2},
                                  OtherValue{"position_dependent_friction", "period", 10.0},
                                  OtherValue{"encoder_cyclic_error", "cosine", 0.01},
                                  OtherValue{"torque_ripple", "cosine", 0.15},
                                  OtherValue{"dwell_stiction", "time_constant", 0.8}};

/// Speeds of the jogs, rad/s, in both directions, and the rests between them, s.
constexpr std::array kJogs{1.5, 4.0, 90.0, 10.0, 3.0, 25.0, 60.0, 6.0, 90.0, 15.0};
constexpr std::array kRests_s{0.1, 0.2, 0.4, 0.8};

sim::DriveDescription drive_without(const sim::EffectInfo& info) {
  sim::DriveDescription drive = *paper_drive("x");
  if (!info.base) std::erase_if(drive.effects, [&](const sim::EffectEntry& entry) { return entry.kind == info.kind; });
  if (info.stage == sim::Stage::table) drive.data.load_encoder_resolution = kScale_mm;
  return drive;
}

sim::DriveDescription drive_with(const sim::EffectInfo& info) {
  sim::DriveDescription drive = drive_without(info);
  if (info.base) {
    for (auto& [id, value] : std::ranges::find(drive.effects, info.kind, &sim::EffectEntry::kind)->parameters)
      value *= 1.0 + kMissing;
    return drive;
  }
  const sim::DriveDescription example = with_example(drive, info);
  drive.effects = example.effects;
  for (sim::EffectEntry& entry : drive.effects)
    for (const OtherValue& other : kOtherValues)
      if (entry.kind == info.kind && other.kind == info.kind) entry.parameters[std::string(other.id)] = other.value;
  return drive;
}

/// Simulates jogs under speed control with a bandwidth of 6 Hz. Slow jogs start slowly, so that a start shows the
/// torque at which it breaks away.
Record standard_run(const sim::DriveDescription& drive) {
  constexpr double kBandwidth_Hz = 6.0, kJog_s = 0.45, kFast = 20.0, kAcceleration = 900.0, kSlowly = 30.0;
  constexpr std::uint64_t kSeed = 1;
  sim::Plant plant(drive, kSeed);
  const sim::DriveDescription rigid = *paper_drive("x");
  const double gain_V =
      2.0 * std::numbers::pi * kBandwidth_Hz * rigid.find("inertia")->at("J") / drive.data.effort_per_volt();
  const double friction_V = rigid.find("coulomb")->either("positive", "level") / drive.data.effort_per_volt();
  Record record;
  record.path = "standard run";
  record.columns = {"t_s", "u_V", "x_mm", "w_rad_s"};
  if (drive.data.has_load_encoder()) record.columns.emplace_back("x2_mm");
  const double period_s = record.sample_period_s = drive.data.sample_period_s;
  double reference = 0.0;
  const auto run = [&](double target, double seconds) {
    for (int left = static_cast<int>(std::lround(seconds / period_s)); left > 0; --left) {
      const double speed = plant.read_tachometer().value_or(0.0);
      const double step = (0.0 < std::abs(target) && std::abs(target) < kFast ? kSlowly : kAcceleration) * period_s;
      record.t_s.push_back(static_cast<double>(record.size()) * period_s);
      record.x.push_back(static_cast<double>(plant.encoder_counts()) * drive.data.encoder_resolution);
      record.w.push_back(speed);
      if (const auto table = plant.read_load_encoder()) record.x2.push_back(*table);
      reference += std::clamp(target - reference, -step, step);
      const double sign = reference > 0.0 ? 1.0 : reference < 0.0 ? -1.0 : 0.0;
      plant.set_command(gain_V * (reference - speed) + sign * friction_V);
      record.u_V.push_back(plant.command_V());
      plant.advance(period_s);
    }
  };
  std::size_t rest = 0;
  for (const double speed : kJogs)
    for (const double direction : {1.0, -1.0}) {
      run(direction * speed, kJog_s);
      run(0.0, kRests_s[rest++ % kRests_s.size()]);
    }
  return record;
}

using Samples = std::vector<double>;

Samples part_between(const Samples& a, const Samples& b) {
  Samples result(a.size());
  std::ranges::transform(a, b, result.begin(), std::minus<>());
  return result;
}

double rms_of_finite(const Samples& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value * value, count += 1.0;
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

/// Plot of table position by its scale minus motor position, µm.
EffectPicture picture_by_scale(const sim::EffectInfo& info, const Record& with, const Record& without) {
  const auto error_um = [](const Record& record) {
    Samples error = part_between(record.x2, record.x);
    for (double& value : error) value *= 1e3;
    return error;
  };
  EffectPicture picture;
  const Samples error = error_um(with);
  picture.stands_out = rms_of_finite(error) / rms_of_finite(error_um(without));
  const bool over_time = std::ranges::find(info.along, "time") != info.along.end();
  picture.plot.x = over_time ? Axis{"time", "s"} : Axis{"position", "mm"};
  picture.plot.y = {"table minus motor", "µm"};
  ScatterSeries points{"measured", SeriesRole::residual, SeriesStyle::points, {}, {}, {}, {}};
  constexpr std::size_t kEvery = 20;
  for (std::size_t k = 0; k < with.size(); k += kEvery) {
    points.x.push_back(over_time ? with.t_s[k] : with.x[k]);
    points.y.push_back(error[k]);
  }
  picture.plot.series.push_back(std::move(points));
  return picture;
}

/// Plot of the residual of the base model and the effect's contribution, over the first coordinate of the catalogue.
ScatterPlot plain_plot(const sim::EffectInfo& info, const ResidualEffort& samples, const Samples& part) {
  ScatterPlot plot;
  plot.y = {"torque residual", "Nm"};
  append_curves(coordinate_of(info.along.empty() ? "speed" : info.along.front(), sim::DriveKind::rotary), samples, part,
                plot);
  return plot;
}

}  // namespace

EffectPicture picture_of(const sim::EffectInfo& info) {
  const sim::DriveDescription machine = drive_with(info), model = drive_without(info);
  const Record with = standard_run(machine), without = standard_run(model);
  EffectPicture picture;
  if (info.stage == sim::Stage::table) {
    picture = picture_by_scale(info, with, without);
  } else {
    PreparedSets sets;
    sets.training = compare_on({&with}, model, kWindow_s, Measure::motion);
    const RecordSet null = compare_on({&without}, model, kWindow_s, Measure::motion);
    const bool of_speed = info.stage == sim::Stage::tachometer;
    const auto missing_on = [&](const RecordSet& set) {
      return of_speed ? residual_of_speed_channel(model, set)
                      : std::move(residuals_on({&model, &machine}, set).front());
    };
    const ResidualEffort lacking = missing_on(sets.training);
    picture.stands_out = rms_of_finite(lacking.missing) / rms_of_finite(missing_on(null).missing);
    std::vector<FoundEffect> found;
    if (!info.base) found = found_effects(machine, {std::string(info.kind)}, sets);
    if (found.empty()) {
      const std::vector<ResidualEffort> residuals = residuals_on({&model, &machine}, sets.training);
      picture.plot = plain_plot(info, lacking, part_between(residuals.front().missing, residuals.back().missing));
    } else {
      picture.plot = effect_plot(found.front());
      picture.explained = explained_share(found.front());
    }
  }
  picture.plot.large = false;
  picture.plot.title = std::string(info.title);
  picture.plot.caption = fmt::format(
      "Residual of a model without it, on the standard run of a simulated axis: {:.2g} times as large as "
      "without this effect. Line: the effect's own part.",
      picture.stands_out);
  return picture;
}

}  // namespace host::workbench
