#include "host/effort/effort_orders.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/evidence/period_search.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An order stays when it takes this part of what is left of the squared error, in training and in judging alike.
constexpr double kLeastGainOfOrder = 0.015;
constexpr std::size_t kMostOrders = 12;
constexpr int kMostWholeOrders = 120;

/// Gauss-Jordan pivoting on one variable of a moment matrix: afterwards it stands for the regression on it.
void sweep(MatrixXd& moments, Index pivot) {
  const double d = moments(pivot, pivot);
  const VectorXd column = moments.col(pivot), row = moments.row(pivot).transpose();
  moments.noalias() -= column * row.transpose() / d;
  moments.col(pivot) = column / d;
  moments.row(pivot) = row.transpose() / d;
  moments(pivot, pivot) = -1.0 / d;
}

struct Selection {
  MatrixXd train, judge;       ///< moments of base, orders and effort
  std::vector<Index> taken;    ///< swept variables
  std::vector<Index> refused;  ///< orders that did not replicate
  Index last;

  double left_train() const { return train(last, last); }
  /// Squared error on the judging rows of what was fitted on the training rows.
  double left_judge() const {
    VectorXd residual = VectorXd::Zero(train.rows());
    residual(last) = 1.0;
    for (const Index k : taken) residual(k) = -train(k, last);
    return residual.dot(judge * residual);
  }
};

OrderChoice select(const EffortRows& rows, const MatrixXd& base, const VectorXd& weight, double period, int most) {
  std::vector<double> all;
  for (int order = 1; order <= most; ++order) all.push_back(order);
  MatrixXd columns(rows.x.size(), base.cols() + 2 * Index{most} + 1);
  columns << base, order_columns(rows, weight, period, all), rows.effort;
  MatrixXd train = columns, judge = columns;
  for (Index k = 0; k < columns.rows(); ++k)
    (rows.judges[static_cast<std::size_t>(k)] ? train : judge).row(k).setZero();
  Selection selection{train.transpose() * train, judge.transpose() * judge, {}, {}, columns.cols() - 1};
  const VectorXd scale = selection.train.diagonal();
  for (Index k = 0; k < base.cols(); ++k) {
    if (selection.train(k, k) <= 1e-9 * scale(k)) continue;  // says nothing beside the others
    sweep(selection.train, k);
    selection.taken.push_back(k);
  }
  const double train_before = selection.left_train(), judge_before = selection.left_judge();
  OrderChoice choice{period, {}, 1.0, 1.0};
  double train_left = train_before, judge_left = judge_before;
  std::vector<bool> out(static_cast<std::size_t>(most) + 1, false);
  int refusals = 0;
  constexpr int kMostRefusals = 3;
  while (choice.orders.size() < kMostOrders && refusals < kMostRefusals) {
    int best = 0;
    double most_gain = kLeastGainOfOrder * train_left;
    for (int order = 1; order <= most; ++order) {
      if (out[static_cast<std::size_t>(order)]) continue;
      const Index c = base.cols() + 2 * (Index{order} - 1);
      const double cc = selection.train(c, c), ss = selection.train(c + 1, c + 1), cs = selection.train(c, c + 1);
      const double determinant = cc * ss - cs * cs;
      // What hardly stands out of the others' span gets its size from noise.
      constexpr double kOwnShare = 0.05;
      if (cc < kOwnShare * scale(c) || ss < kOwnShare * scale(c + 1) || determinant < 0.05 * cc * ss) continue;
      const double cy = selection.train(c, selection.last), sy = selection.train(c + 1, selection.last);
      const double gain = (ss * cy * cy - 2.0 * cs * cy * sy + cc * sy * sy) / determinant;
      if (gain > most_gain) {
        most_gain = gain;
        best = order;
      }
    }
    if (best == 0) break;
    out[static_cast<std::size_t>(best)] = true;
    Selection further = selection;
    const Index c = base.cols() + 2 * (Index{best} - 1);
    for (const Index k : {c, c + 1}) {
      sweep(further.train, k);
      further.taken.push_back(k);
    }
    const double judged = further.left_judge();
    if (judged > (1.0 - kLeastGainOfOrder) * judge_left) {
      ++refusals;
      continue;
    }
    selection = std::move(further);
    train_left = selection.left_train();
    judge_left = judged;
    choice.orders.push_back(best);
  }
  choice.left_train = train_left / train_before;
  choice.left_validate = judge_left / judge_before;
  return choice;
}

/// Squared error on the training rows of base and orders together.
double left_with(const EffortRows& rows, const MatrixXd& base, const VectorXd& weight, double period,
                 const std::vector<double>& orders) {
  MatrixXd columns(rows.x.size(), base.cols() + 2 * static_cast<Index>(orders.size()));
  columns << base, order_columns(rows, weight, period, orders);
  const VectorXd train = VectorXd::NullaryExpr(
      rows.x.size(), [&](Index k) { return rows.judges[static_cast<std::size_t>(k)] ? 0.0 : 1.0; });
  columns = train.asDiagonal() * columns;
  const VectorXd effort = train.cwiseProduct(rows.effort);
  const VectorXd projection = columns.transpose() * effort;
  return effort.squaredNorm() -
         projection.dot((columns.transpose() * columns).completeOrthogonalDecomposition().solve(projection));
}

/// A period where the error is least, between those that the spectrum cannot tell from the one it found: the fastest
/// order may be off by a quarter of a wave over the travel.
double refined_period(const EffortRows& rows, const MatrixXd& base, const VectorXd& weight, const OrderChoice& choice) {
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff();
  const double reach = 0.25 * choice.period / (travel * std::ranges::max(choice.orders)) * choice.period;
  const auto left = [&](double period) { return left_with(rows, base, weight, period, choice.orders); };
  // Golden section: 16 steps leave 1/2000 of the interval, a thousandth of a wave.
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 16;
  double low = choice.period - reach, high = choice.period + reach;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low), at_a = left(a), at_b = left(b);
  for (int step = 0; step < kSteps; ++step) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      at_a = left(a = high - kGolden * (high - low));
    } else {
      low = a, a = b, at_a = at_b;
      at_b = left(b = low + kGolden * (high - low));
    }
  }
  return 0.5 * (low + high);
}

/// The same orders counted over a turn of the shaft, where the period is a whole part of one as nearly as the travel
/// can tell.
OrderChoice as_orders_of_a_turn(OrderChoice choice, double turn, double travel) {
  if (choice.orders.empty()) return choice;
  const double parts = std::round(turn / choice.period);
  if (parts < 1.0 || std::abs(turn / choice.period - parts) > 0.25 * turn / travel) return choice;
  choice.period = turn;
  for (double& order : choice.orders) order *= parts;
  return choice;
}

}  // namespace

bool comes_back(const OrderChoice& choice, const sim::DataSheet& data, const EffortRows& rows) {
  constexpr double kTimes = 2.0;
  if (data.kind == sim::DriveKind::rotary && choice.period == 2.0 * std::numbers::pi * data.lead) return true;
  long common = 0;
  for (const double order : choice.orders) common = std::gcd(common, std::lround(order));
  return kTimes * choice.period <= static_cast<double>(common) * (rows.x.maxCoeff() - rows.x.minCoeff());
}

MatrixXd order_columns(const EffortRows& rows, const VectorXd& weight, double period,
                       const std::vector<double>& orders) {
  MatrixXd columns(rows.x.size(), 2 * static_cast<Index>(orders.size()));
  for (std::size_t n = 0; n < orders.size(); ++n) {
    const VectorXd angle = 2.0 * std::numbers::pi * orders[n] / period * rows.x;
    columns.col(2 * static_cast<Index>(n)) = weight.array() * angle.array().cos();
    columns.col(2 * static_cast<Index>(n) + 1) = weight.array() * angle.array().sin();
  }
  return columns;
}

OrderChoice choose_orders(const sim::DataSheet& data, const EffortRows& rows, const MatrixXd& base,
                          const VectorXd& weight, const VectorXd& left, Waves waves) {
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff();
  std::vector<double> speeds(rows.w.data(), rows.w.data() + rows.w.size());
  for (double& w : speeds) w = std::abs(w);
  const double usual = median(std::move(speeds)) * data.lead;
  // What passes faster than the filter lets through cannot be seen, nor what the encoder's steps make themselves.
  constexpr double kPassed = 0.8, kStepsAPeriod = 8.0;
  const double shortest =
      std::max({usual / (kPassed * rows.lowest_cutoff_Hz), kStepsAPeriod * data.encoder_resolution, travel / 5000.0});
  const auto orders_of = [&](double period, double most) {
    return static_cast<int>(std::clamp(period / shortest, 0.0, most));
  };
  OrderChoice best;
  const auto consider = [&](double period, double most, double advantage) {
    const int orders = orders_of(period, most);
    if (orders < 1) return;
    const OrderChoice choice = select(rows, base, weight, period, orders);
    if (!choice.orders.empty() && choice.left_validate < advantage * best.left_validate) best = choice;
  };
  // One long wave is told from the series that stands for it by leaving as little.
  const auto consider_wave = [&](double period) {
    constexpr double kAsLittle = 1.1;
    const OrderChoice choice =
        select(rows, base, weight, refined_period(rows, base, weight, {period, {1.0}, 1.0, 1.0}), 2);
    if (!choice.orders.empty() && (best.orders.empty() || choice.orders.size() <= best.orders.size()) &&
        choice.left_validate < kAsLittle * best.left_validate)
      best = choice;
  };
  const double turn = 2.0 * std::numbers::pi * data.lead;
  const bool turns = data.kind == sim::DriveKind::rotary && travel > turn;
  // A weight on an arm or a pendulum shows in a quarter of a turn; what has less looks like a spring.
  constexpr double kLeastOfATurn = 0.25;
  if (turns)
    consider(turn, kMostWholeOrders, 1.0);
  else if (data.kind == sim::DriveKind::rotary && travel > kLeastOfATurn * turn)
    consider(turn, 1.0, 1.0);
  TravelSignal signal;
  for (Index k = 0; k < rows.x.size(); ++k) {
    if (rows.judges[static_cast<std::size_t>(k)]) continue;
    signal.x.push_back(rows.x(k));
    signal.value.push_back(left(k));
    signal.weight.push_back(weight(k));
  }
  constexpr std::size_t kPeaks = 3;
  constexpr double kPeriodsOfTravel = 3.0, kMostMultiples = 8.0;
  // A period that nobody knows of must explain clearly more than the orders of a turn.
  constexpr double kAdvantage = 0.9;
  for (const PeriodPeak& peak : find_periods(signal, shortest, travel / kPeriodsOfTravel, kPeaks))
    for (const double multiple : {1.0, 2.0, 3.0, 4.0})
      if (multiple * peak.period < travel)
        consider(multiple * peak.period, kMostMultiples * multiple, best.orders.empty() ? 1.0 : kAdvantage);
  if (waves == Waves::any)
    for (const double part : {2.0, 1.4, 1.0, 0.7, 0.5}) consider_wave(part * travel);
  if (turns) best = as_orders_of_a_turn(best, turn, travel);
  if (!best.orders.empty() && best.period != turn) best.period = refined_period(rows, base, weight, best);
  return best;
}

}  // namespace host
