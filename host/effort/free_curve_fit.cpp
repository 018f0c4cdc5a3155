#include "host/effort/free_curve_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/effort/effort_waves.hpp"
#include "host/evidence/period_search.hpp"
#include "host/statistics.hpp"
#include "sim/curve.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Part of the validation rows' squared error that additional knots must explain.
constexpr double kLeastGainOfCurve = 0.01;

struct Coordinate {
  VectorXd at;
  VectorXd weight;      ///< -1 or 1: friction changes sign with the motion
  double period = 0.0;  ///< `at` runs from 0 to this and starts again; 0 if the curve does not repeat
};

using Mask = Eigen::Array<bool, Eigen::Dynamic, 1>;

/// Columns of a constant and the first orders of a period.
MatrixXd orders_of(const EffortRows& rows, double period) {
  constexpr Index kOrders = 6;
  MatrixXd columns(rows.x.size(), 2 * kOrders + 1);
  columns.col(0).setOnes();
  for (Index n = 0; n < kOrders; ++n)
    columns.middleCols(2 * n + 1, 2) =
        wave_columns(rows, VectorXd::Ones(rows.x.size()), {period, static_cast<double>(n + 1)});
  return columns;
}

/// Squared error on the rows `judged`, with factors fitted to the rows `fitted`.
double left_elsewhere(const VectorXd& left, const MatrixXd& columns, const Mask& fitted, const Mask& judged) {
  const VectorXd use = fitted.cast<double>();
  const VectorXd factors = least_norm_solution(use.asDiagonal() * columns, use.cwiseProduct(left));
  return judged.select(left - columns * factors, 0.0).matrix().squaredNorm();
}

/// Whether a period that is fitted to two thirds of the travel also shows in the other third, for each of the thirds.
bool comes_back(const EffortRows& rows, const VectorXd& left, double period) {
  const MatrixXd columns = orders_of(rows, period);
  const double first = rows.x.minCoeff(), third = (rows.x.maxCoeff() - first) / 3.0;
  for (const double begin : {first, first + third, first + 2.0 * third}) {
    const Mask other = rows.x.array() >= begin && rows.x.array() <= begin + third;
    if (left_elsewhere(left, columns, !other, other) >= left_elsewhere(left, columns.leftCols(1), !other, other))
      return false;
  }
  return true;
}

/// The shortest travel after which the best model's residual repeats; empty if it does not.
std::optional<double> period_of(const EffortScreen& screen) {
  const EffortRows& rows = screen.rows;
  const VectorXd& left = screen.best().residual;
  TravelSignal signal;
  for (Index k = 0; k < rows.x.size(); ++k) {
    if (rows.judges[static_cast<std::size_t>(k)]) continue;
    signal.x.push_back(rows.x(k));
    signal.value.push_back(left(k));
    signal.weight.push_back(1.0);
  }
  constexpr std::size_t kPeaks = 3;
  constexpr double kPeriodsOfTravel = 3.0, kAlike = 1.02;
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff();
  const double shortest = shortest_wave(screen.base.model.data, rows);
  std::vector<double> periods;
  for (const PeriodPeak& peak : find_periods(signal, shortest, travel / kPeriodsOfTravel, kPeaks))
    for (const double multiple : {1.0, 2.0, 3.0, 4.0})
      if (multiple * peak.period < travel / 2.0) periods.push_back(multiple * peak.period);
  if (const double turn = screen.base.model.data.turn(); turn > 0.0 && turn < travel) periods.push_back(turn);
  std::ranges::sort(periods);
  std::optional<double> best;
  const Mask judges =
      Mask::NullaryExpr(left.size(), [&](Index k) { return bool{rows.judges[static_cast<std::size_t>(k)]}; });
  double least = left_elsewhere(left, MatrixXd::Ones(left.size(), 1), !judges, judges);
  for (const double period : periods) {
    const double squares = left_elsewhere(left, orders_of(rows, period), !judges, judges);
    if (kAlike * squares > least || !comes_back(rows, left, period)) continue;
    least = squares;
    best = period;
  }
  return best;
}

std::optional<Coordinate> coordinate_of(const EffortScreen& screen, std::string_view over) {
  const EffortRows& rows = screen.rows;
  const VectorXd one = VectorXd::Ones(rows.w.size());
  if (over == "speed") return Coordinate{rows.w, one};
  const VectorXd direction = rows.w.unaryExpr([](double w) { return w > 0.0 ? 1.0 : -1.0; });
  if (over == "time") return Coordinate{rows.t_s, one};
  if (over == "friction_over_time") return Coordinate{rows.t_s, direction};
  if (over == "current") return Coordinate{rows.effort, one};
  if (!rows.has_position) return {};
  if (over == "position") return Coordinate{rows.x, one};
  if (over == "phase") {
    const std::optional<double> period = period_of(screen);
    if (!period) return {};
    return Coordinate{rows.x.unaryExpr([&](double x) { return x - *period * std::floor(x / *period); }), one, *period};
  }
  return Coordinate{over == "friction_along_position" ? rows.x : travel_since_reversal(rows), direction};
}

std::vector<double> periodic_knots(double period, std::size_t count) {
  std::vector<double> knots;
  for (std::size_t n = 0; n < count; ++n)
    knots.push_back(period * static_cast<double>(n) / static_cast<double>(count - 1));
  return knots;
}

/// Knots with equal numbers of training rows between them, or with equal distances over a period.
std::vector<double> knots_of(const EffortRows& rows, const Coordinate& coordinate, std::size_t count) {
  const VectorXd& at = coordinate.at;
  if (coordinate.period > 0.0) return periodic_knots(coordinate.period, count);
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

/// Value of each knot's hat function in each row; the hats sum to 1.
MatrixXd curve_hats(const Coordinate& coordinate, const std::vector<double>& knots) {
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
  if (coordinate.period > 0.0) {  // the last knot equals the first
    columns.col(0) += columns.rightCols(1);
    columns.conservativeResize(Eigen::NoChange, columns.cols() - 1);
  }
  return columns;
}

/// The curve as an entry of the model: `values` at `knots`, with intervals that hold for fixed other parameters.
sim::EffectEntry entry_of(std::string_view over, const std::vector<double>& knots, const VectorXd& values,
                          const MatrixXd& information, double variance) {
  sim::EffectEntry entry;
  entry.kind = "free_curve";
  entry.over = over;
  const MatrixXd covariance = variance * symmetric_inverse(information);
  for (std::size_t n = 0; n < knots.size(); ++n) {
    const Index c = static_cast<Index>(n) % values.size();
    const std::string id = sim::numbered_id("value", static_cast<double>(n));
    entry.parameters[sim::numbered_id("knot", static_cast<double>(n))] = knots[n];
    entry.parameters[id] = values(c);
    const double reach = kNormal95 * std::sqrt(std::max(0.0, covariance(c, c)));
    entry.ci95[id] = {values(c) - reach, values(c) + reach};
  }
  return entry;
}

std::optional<FreeCurveFit> fitted(const EffortScreen& screen, std::string_view over, const Coordinate& coordinate,
                                   std::size_t count) {
  const EffortRows& rows = screen.rows;
  const std::vector<double> knots = knots_of(rows, coordinate, count);
  if (knots.size() < 2) return {};
  EffortTerm term{"free_curve", curve_hats(coordinate, knots), {}, {}, {}};
  term.sign.assign(static_cast<std::size_t>(term.columns.cols()), 0);
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
  return FreeCurveFit{std::string(over), knots.size(), coordinate.period, *std::move(with)};
}

std::optional<FreeCurveFit> fitted_with_as_many_knots_as_pay(const EffortScreen& screen, std::string_view over) {
  const std::optional<Coordinate> coordinate = coordinate_of(screen, over);
  if (!coordinate) return {};
  std::optional<FreeCurveFit> best;
  for (const std::size_t count : {3U, 5U, 8U, 12U, 17U, 25U}) {
    std::optional<FreeCurveFit> fit = fitted(screen, over, *coordinate, count);
    const double limit = best ? std::sqrt(1.0 - kLeastGainOfCurve) * best->model.validate : screen.best().validate;
    if (fit && fit->model.validate < limit) best = std::move(fit);
  }
  return best;
}

/// A curve over the torque cannot be told from inertia, so the inertia is held. A motion without acceleration gives no
/// curve.
std::optional<FreeCurveFit> fitted_over_effort(const EffortScreen& screen) {
  if (screen.rows.steady) return {};
  EffortScreen standing = screen;
  sim::DriveDescription& model = standing.chosen.empty() ? standing.base.model : standing.chosen.back().model;
  const bool was_free = model.find("inertia")->held.insert("J").second;
  std::optional<FreeCurveFit> fit = fitted_with_as_many_knots_as_pay(standing, "current");
  if (fit && was_free) fit->model.model.find("inertia")->held.erase("J");
  return fit;
}

}  // namespace

std::optional<FreeCurveFit> fit_free_curve(const EffortScreen& screen, std::string_view over) {
  std::optional<FreeCurveFit> best;
  for (const std::string_view name : sim::kCurveCoordinates) {
    // The torque would explain itself, so a curve over it is fitted only on request.
    if (over.empty() ? name == "current" : name != over) continue;
    std::optional<FreeCurveFit> own =
        name == "current" ? fitted_over_effort(screen) : fitted_with_as_many_knots_as_pay(screen, name);
    if (own && (!best || own->model.validate < best->model.validate)) best = std::move(own);
  }
  return best;
}

}  // namespace host
