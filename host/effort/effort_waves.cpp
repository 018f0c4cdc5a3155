#include "host/effort/effort_waves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/statistics.hpp"
#include "sim/catalogue.hpp"
#include "sim/drive.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Distance of neighbouring waves of the grid, in periods over the whole travel.
constexpr double kApart = 0.3;
constexpr int kMostOrders = 120, kMostFreeWaves = 400;
/// A weight on an arm is visible over a quarter of a turn; over less travel it looks like a spring.
constexpr double kLeastOfATurn = 0.25;

double travel_of(const EffortRows& rows) { return rows.x.maxCoeff() - rows.x.minCoeff(); }

std::string words_of(const std::vector<double>& orders, double period, sim::DriveKind kind) {
  return fmt::format("{} {:g} of {:.5g} {}", orders.size() == 1 ? "order" : "orders", fmt::join(orders, ", "), period,
                     kind == sim::DriveKind::rotary ? "mm" : "m");
}

/// Adds a wave to the entry of its kind and period, or a new entry.
bool write_wave(const std::string& kind, const Wave& wave, double cosine, double sine, sim::DriveDescription& model) {
  for (sim::EffectEntry& entry : model.effects) {
    if (entry.kind != kind || entry.at("period") != wave.period) continue;
    std::vector<sim::HarmonicTerm> terms = sim::harmonics_of(entry);
    terms.push_back({wave.order, cosine, sine});
    std::ranges::sort(terms, {}, &sim::HarmonicTerm::order);
    sim::set_harmonics(entry, terms);
    return true;
  }
  sim::EffectEntry entry;
  entry.kind = kind;
  entry.parameters["period"] = wave.period;
  sim::set_harmonics(entry, {{wave.order, cosine, sine}});
  return append_within_bounds(model, std::move(entry));
}

}  // namespace

double shortest_wave(const sim::DataSheet& data, const EffortRows& rows) {
  std::vector<double> speeds(rows.w.size());
  std::ranges::transform(rows.w, speeds.begin(), [](double w) { return std::abs(w); });
  constexpr double kPassed = 0.8, kStepsAPeriod = 8.0;
  const double usual = median(std::move(speeds)) * data.lead;
  return std::max(usual / (kPassed * rows.lowest_cutoff_Hz), kStepsAPeriod * data.encoder_resolution);
}

std::vector<Wave> waves_over(const sim::DataSheet& data, const EffortRows& rows, double longest) {
  const double travel = travel_of(rows), turn = data.turn(), shortest = shortest_wave(data, rows);
  std::vector<Wave> waves;
  if (!(travel > 0.0)) return waves;
  if (turn > 0.0 && travel > kLeastOfATurn * turn) {
    const double most = travel > turn ? std::min<double>(kMostOrders, turn / shortest) : 1.0;
    for (int order = 1; order <= std::max(1.0, most); ++order) waves.push_back({turn, static_cast<double>(order)});
  }
  const double first = 1.0 / longest;
  for (int k = 0; k < kMostFreeWaves; ++k) {
    const double waves_over_travel = first + kApart * k, period = travel / waves_over_travel;
    if (period < shortest) break;
    waves.push_back({period, 1.0});
  }
  return waves;
}

std::vector<double> log_priors(const std::vector<Wave>& waves, const sim::DataSheet& data) {
  const double turn = data.turn();
  double of_turn = 0.0, free = 0.0;
  for (const Wave& wave : waves) (wave.period == turn ? of_turn : free) += 1.0 / wave.order;
  const double half = of_turn > 0.0 && free > 0.0 ? 0.5 : 1.0;
  std::vector<double> logs;
  for (const Wave& wave : waves) logs.push_back(std::log(half / wave.order / (wave.period == turn ? of_turn : free)));
  return logs;
}

MatrixXd wave_columns(const EffortRows& rows, const VectorXd& weight, const Wave& wave) {
  MatrixXd columns(rows.x.size(), 2);
  const double per_travel = wave.order / wave.period;
  for (Index k = 0; k < columns.rows(); ++k) {
    // Gain of the rows' zero-phase filter for the frequency of a wave at this speed.
    const double cutoff_Hz = rows.signals[rows.record[static_cast<std::size_t>(k)]].cutoff_Hz;
    const double passing = std::pow(per_travel * rows.w(k) * rows.lead / cutoff_Hz, 2), fourth = passing * passing;
    const double seen = weight(k) / (1.0 + fourth * fourth);
    columns(k, 0) = seen * sim::cosine_of_turns(per_travel * rows.x(k));
    columns(k, 1) = seen * sim::cosine_of_turns(per_travel * rows.x(k) - 0.25);
  }
  return columns;
}

MatrixXd varying_inertia_columns(const EffortRows& rows, const Wave& wave) {
  const double per_radian = 2.0 * std::numbers::pi * wave.order / wave.period * rows.lead;
  const MatrixXd of_slope = wave_columns(rows, 0.5 * per_radian * rows.w.cwiseAbs2(), wave);
  MatrixXd columns = wave_columns(rows, rows.acceleration, wave);
  columns.col(0) -= of_slope.col(1);
  columns.col(1) += of_slope.col(0);
  return columns;
}

MatrixXd encoder_error_columns(const sim::DriveDescription& model, const EffortRows& rows, const Wave& wave) {
  const sim::EffectEntry *inertia = model.find("inertia"), *viscous = model.find("viscous");
  const double per_travel = 2.0 * std::numbers::pi * wave.order / wave.period;
  const double mass = inertia == nullptr ? 0.0 : inertia->at("J"), drag = viscous == nullptr ? 0.0 : viscous->at("B");
  // For an error e(x), the reading exceeds the motor's speed by v e' and its acceleration by (dv/dt) e' + v^2 e''.
  const MatrixXd of_slope = wave_columns(rows, per_travel * (mass * rows.acceleration + drag * rows.w), wave);
  MatrixXd columns = wave_columns(rows, per_travel * per_travel * rows.lead * mass * rows.w.cwiseAbs2(), wave);
  columns.col(0) += of_slope.col(1);
  columns.col(1) -= of_slope.col(0);
  return columns;
}

double encoder_error_unit(const sim::DriveDescription& given, const sim::DriveDescription& fitted) {
  const sim::EffectEntry *before = given.find("inertia"), *after = fitted.find("inertia");
  return before == nullptr || after == nullptr ? 1.0 : after->at("J") / before->at("J");
}

EffortTerm wave_term(const sim::DriveDescription& model, const EffortRows& rows, const std::string& kind,
                     const WaveColumns& columns_of, const Wave& wave) {
  EffortTerm term{kind, columns_of(wave), {0, 0}, {}, {}};
  term.write = [kind, wave, &model](const VectorXd& factors, sim::DriveDescription& fitted) {
    const double unit = kind == "position_dependent_friction" ? coulomb_level(fitted)
                        : kind == "encoder_cyclic_error"      ? encoder_error_unit(model, fitted)
                                                              : -1.0;
    return unit != 0.0 && write_wave(kind, wave, factors(0) / unit, factors(1) / unit, fitted);
  };
  term.can_repeat = true;
  term.words = words_of({wave.order}, wave.period, model.data.kind);
  if (wave.period == model.data.turn()) return term;
  term.neighbours = [&model, &rows, kind, columns_of, wave](double part) {
    constexpr double kWaves = 8.0;  // the largest part is a quarter of a wave over the travel
    std::vector<std::function<EffortTerm()>> around;
    for (const double sign : {-1.0, 1.0}) {
      const double factor = 1.0 + sign * kWaves * part * wave.period / travel_of(rows);
      if (factor > 0.5)
        around.push_back([&model, &rows, kind, columns_of, other = Wave{factor * wave.period, wave.order}] {
          return wave_term(model, rows, kind, columns_of, other);
        });
    }
    return around;
  };
  return term;
}

std::string words_of_waves(const sim::DriveDescription& model, const std::string& kind) {
  std::vector<std::string> parts;
  for (const sim::EffectEntry& entry : model.effects) {
    if (entry.kind != kind) continue;
    std::vector<double> orders;
    for (const sim::HarmonicTerm& term : sim::harmonics_of(entry)) orders.push_back(term.order);
    parts.push_back(words_of(orders, entry.at("period"), model.data.kind));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace host
