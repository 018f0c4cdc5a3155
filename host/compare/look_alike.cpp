#include "host/compare/look_alike.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "host/cancellation.hpp"
#include "host/compare/residual_figures.hpp"
#include "host/exit_codes.hpp"
#include "host/record/drive_units.hpp"
#include "host/report/effect_pages.hpp"
#include "host/report/text_format.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Means of both directions in bins, one after the other, with the number of samples of each.
struct Shape {
  std::vector<double> y, weight;
};

Shape shape_of(const ResidualEffort& samples, const std::vector<double>& values, const ResidualCoordinate& over) {
  Shape shape;
  for (const ScatterSeries& curve : direction_curves(samples, values, over)) {
    shape.y.insert(shape.y.end(), curve.y.begin(), curve.y.end());
    shape.weight.insert(shape.weight.end(), curve.samples.begin(), curve.samples.end());
  }
  return shape;
}

double product(const Shape& a, const Shape& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.y.size(); ++k)
    if (std::isfinite(a.y[k]) && std::isfinite(b.y[k]) && std::isfinite(a.weight[k]))
      sum += a.weight[k] * a.y[k] * b.y[k];
  return sum;
}

/// Share of `whole` in the plane of `a` and `b`, as the cosine of their angle.
double likeness_of(const Shape& whole, const Shape& a, const std::optional<Shape>& b) {
  const double ww = product(whole, whole), aa = product(a, a), wa = product(whole, a);
  if (!(ww > 0.0) || !(aa > 0.0)) return 0.0;
  double explained = wa * wa / aa;
  if (b) {
    const double bb = product(*b, *b), ab = product(a, *b), wb = product(whole, *b);
    const double rest = bb - ab * ab / aa, beyond = wb - ab * wa / aa;
    if (rest > 1e-9 * bb) explained += beyond * beyond / rest;
  }
  return std::sqrt(std::clamp(explained / ww, 0.0, 1.0));
}

/// The whole fraction of `longest` at which the residual has most of a wave; `by_direction`: with the sign of the
/// speed.
double best_period(const ResidualEffort& samples, double longest, bool by_direction) {
  constexpr int kMostOrders = 72;
  double best = longest, most = -1.0;
  for (int order = 1; order <= kMostOrders; ++order) {
    double cosine = 0.0, sine = 0.0;
    for (std::size_t k = 0; k < samples.x.size(); ++k) {
      const double phase = 2.0 * std::numbers::pi * order * samples.x[k] / longest;
      const double value = samples.missing[k] * (by_direction ? std::copysign(1.0, samples.w[k]) : 1.0);
      if (!std::isfinite(value)) continue;
      cosine += value * std::cos(phase);
      sine += value * std::sin(phase);
    }
    if (const double size = std::hypot(cosine, sine); size > most) most = size, best = longest / order;
  }
  return best;
}

/// with_example(); nullopt if the model cannot take the effect.
std::optional<sim::DriveDescription> machine_with(const sim::DriveDescription& model, const sim::EffectInfo& info) {
  try {
    return with_example(model, info);
  } catch (const Failure&) {
    return std::nullopt;
  }
}

/// The effect's own part on the records, as a shape.
Shape own_shape(const sim::DriveDescription& model, const sim::DriveDescription& machine, const RecordSet& set,
                const ResidualCoordinate& over) {
  const std::vector<ResidualEffort> residuals = residuals_on({&model, &machine}, set);
  std::vector<double> part(residuals.front().missing.size());
  for (std::size_t k = 0; k < std::min(part.size(), residuals.back().missing.size()); ++k)
    part[k] = residuals.front().missing[k] - residuals.back().missing[k];
  return shape_of(residuals.front(), part, over);
}

}  // namespace

std::vector<LookAlike> look_alikes(const sim::DriveDescription& model, const RecordSet& set,
                                   const std::string& coordinate, double period) {
  const ResidualEffort samples = residuals_on({&model}, set).front();
  const ResidualCoordinate over = coordinate_of(coordinate, model.data.kind, period);
  const Shape whole = shape_of(samples, samples.missing, over);
  std::vector<LookAlike> alike;
  for (const sim::EffectInfo* info : sim::catalogue()) {
    const bool is_apart = info->stage == sim::Stage::table || info->stage == sim::Stage::tachometer;
    if (info->base || info->curve || is_apart || model.find(info->kind) != nullptr) continue;
    std::optional<sim::DriveDescription> machine = machine_with(model, *info);
    if (!machine) continue;
    throw_if_cancelled();
    sim::EffectEntry& entry = *machine->find(info->kind);
    std::optional<Shape> other;
    if (info->periodic) {
      if (period > 0.0) entry.parameters["period"] = best_period(samples, period, info->stage == sim::Stage::friction);
      const double size = std::hypot(entry.at("cosine"), entry.has("sine") ? entry.at("sine") : 0.0);
      sim::DriveDescription shifted = *machine;
      shifted.find(info->kind)->parameters["cosine"] = 0.0;
      shifted.find(info->kind)->parameters["sine"] = size;
      entry.parameters["cosine"] = size;
      entry.parameters["sine"] = 0.0;
      other = own_shape(model, shifted, set, over);
    }
    const Shape own = own_shape(model, *machine, set, over);
    if (own.y.size() != whole.y.size() || (other && other->y.size() != whole.y.size())) continue;
    alike.push_back({std::string(info->kind), likeness_of(whole, own, other)});
  }
  std::ranges::stable_sort(alike, std::greater(), &LookAlike::likeness);
  return alike;
}

nlohmann::json likeness_json(const ComparedModel& compared, const Focus& focus, const std::string& coordinate) {
  constexpr std::size_t kMost = 5;
  const double period =
      focus.period_mm ? *focus.period_mm / travel_in_mm(compared.model.data.kind) : ripple_period(compared.model);
  nlohmann::json effects = nlohmann::json::array();
  for (const LookAlike& one : look_alikes(compared.model, compared.set, coordinate, period)) {
    if (effects.size() == kMost) break;
    effects.push_back({{"kind", one.kind},
                       {"title", sim::find_effect(one.kind)->title},
                       {"likeness", rounded_to_digits(one.likeness, 3)}});
  }
  return {{"format", "axis-likeness/1"}, {"over", coordinate}, {"effects", std::move(effects)}};
}

}  // namespace host
