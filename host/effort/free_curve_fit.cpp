#include "host/effort/free_curve_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/statistics.hpp"
#include "sim/curve.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A further knot must take this part of the judging rows' squared error.
constexpr double kLeastGain = 0.01;

/// Travel since the motion last turned over, at the rows.
VectorXd travel_since_reversal(const EffortRows& rows) {
  VectorXd travelled = VectorXd::Zero(rows.w.size());
  for (const EffortSignals& signals : rows.signals) {
    std::size_t next = 0;
    double turned = signals.motion.empty() ? 0.0 : signals.motion.front(), heading = 0.0;
    for (std::size_t k = 1; k < signals.motion.size() && next < signals.kept.size(); ++k) {
      const double step = signals.motion[k] - signals.motion[k - 1];
      if (step * heading < 0.0) turned = signals.motion[k - 1];
      if (step != 0.0) heading = step > 0.0 ? 1.0 : -1.0;
      if (signals.kept[next] == k)
        travelled(static_cast<Index>(signals.first_row + next++)) = std::abs(signals.motion[k] - turned);
    }
  }
  return travelled;
}

struct Coordinate {
  VectorXd at;
  VectorXd weight;  ///< -1 or 1: friction turns with the motion
};

std::optional<Coordinate> coordinate_of(const EffortRows& rows, std::string_view over) {
  const VectorXd one = VectorXd::Ones(rows.w.size());
  if (over == "speed") return Coordinate{rows.w, one};
  if (over == "time") return Coordinate{rows.t_s, one};
  if (over == "current") return Coordinate{rows.effort, one};
  if (!rows.has_position) return {};
  if (over == "position") return Coordinate{rows.x, one};
  return Coordinate{over == "friction_along_position" ? rows.x : travel_since_reversal(rows),
                    rows.w.unaryExpr([](double w) { return w > 0.0 ? 1.0 : -1.0; })};
}

/// Knots that part the training rows evenly.
std::vector<double> knots_of(const EffortRows& rows, const VectorXd& at, std::size_t count) {
  std::vector<double> sorted;
  for (Index k = 0; k < at.size(); ++k)
    if (!rows.judges[static_cast<std::size_t>(k)]) sorted.push_back(at(k));
  std::ranges::sort(sorted);
  std::vector<double> knots;
  for (std::size_t n = 0; n < count; ++n) {
    const double knot = sorted[n * (sorted.size() - 1) / (count - 1)];
    const double apart = 1e-3 * (sorted.back() - sorted.front());
    if (knots.empty() || knot > knots.back() + apart) knots.push_back(knot);
  }
  return knots;
}

/// Each knot's share in each row: hats that sum to 1.
MatrixXd hats(const Coordinate& coordinate, const std::vector<double>& knots) {
  MatrixXd columns = MatrixXd::Zero(coordinate.at.size(), static_cast<Index>(knots.size()));
  for (Index k = 0; k < coordinate.at.size(); ++k) {
    const double q = std::clamp(coordinate.at(k), knots.front(), knots.back());
    const auto above = std::ranges::upper_bound(knots.begin() + 1, knots.end() - 1, q);
    const auto n = static_cast<Index>(above - knots.begin());
    const double part =
        (q - knots[static_cast<std::size_t>(n) - 1]) / (*above - knots[static_cast<std::size_t>(n) - 1]);
    columns(k, n - 1) = coordinate.weight(k) * (1.0 - part);
    columns(k, n) = coordinate.weight(k) * part;
  }
  return columns;
}

/// The curve's entry: `values` at `knots`, with bands that take the rest of the model as it is.
sim::EffectEntry entry_of(std::string_view over, const std::vector<double>& knots, const VectorXd& values,
                          const MatrixXd& information, double variance) {
  sim::EffectEntry entry;
  entry.kind = "free_curve";
  entry.over = over;
  const MatrixXd covariance = variance * information.ldlt().solve(MatrixXd::Identity(values.size(), values.size()));
  for (std::size_t n = 0; n < knots.size(); ++n) {
    const auto c = static_cast<Index>(n);
    const std::string id = sim::numbered_id("value", static_cast<double>(n));
    entry.parameters[sim::numbered_id("knot", static_cast<double>(n))] = knots[n];
    entry.parameters[id] = values(c);
    const double reach = kNormal95 * std::sqrt(std::max(0.0, covariance(c, c)));
    entry.ci95[id] = {values(c) - reach, values(c) + reach};
  }
  return entry;
}

std::optional<FreeCurveFit> fitted(const EffortScreen& screen, std::string_view over, std::size_t count) {
  const EffortRows& rows = screen.rows;
  const std::optional<Coordinate> coordinate = coordinate_of(rows, over);
  if (!coordinate) return {};
  const std::vector<double> knots = knots_of(rows, coordinate->at, count);
  if (knots.size() < 2) return {};
  EffortTerm term{"free_curve", hats(*coordinate, knots), std::vector<int>(knots.size(), 0), {}, {}};
  MatrixXd seen = term.columns;
  for (Index k = 0; k < seen.rows(); ++k)
    if (rows.judges[static_cast<std::size_t>(k)]) seen.row(k).setZero();
  MatrixXd information = seen.transpose() * seen;
  information.diagonal().array() += 1e-9 * information.trace();
  const double variance = std::pow(root_mean_square(rows, screen.best().residual, false), 2);
  term.words = fmt::format("over {}, {} knots", over, knots.size());
  term.write = [&](const VectorXd& values, sim::DriveDescription& model) {
    model.effects.push_back(entry_of(over, knots, values, information, variance));
    return true;
  };
  std::optional<ScreenedModel> with = refitted_with(screen, term);
  if (!with) return {};
  return FreeCurveFit{std::string(over), knots.size(), *std::move(with)};
}

}  // namespace

std::optional<FreeCurveFit> fit_free_curve(const EffortScreen& screen, std::string_view over) {
  std::optional<FreeCurveFit> best;
  for (const std::string_view coordinate : sim::kCurveCoordinates) {
    // The effort explains itself: a curve over it is only drawn where it is asked for.
    if (over.empty() ? coordinate == "current" : coordinate != over) continue;
    std::optional<FreeCurveFit> own;
    for (const std::size_t count : {3U, 5U, 8U, 12U, 17U, 25U}) {
      std::optional<FreeCurveFit> fit = fitted(screen, coordinate, count);
      const double limit = own ? std::sqrt(1.0 - kLeastGain) * own->model.validate : screen.best().validate;
      if (fit && fit->model.validate < limit) own = std::move(fit);
    }
    if (own && (!best || own->model.validate < best->model.validate)) best = std::move(own);
  }
  return best;
}

}  // namespace host
