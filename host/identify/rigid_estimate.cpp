#include "host/identify/rigid_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace host {

namespace {

/// Values g(theta) with intervals from the covariance of theta, by the delta method with central differences.
template <typename Map>
std::vector<Estimate> map_estimate(const Regression& regression, const Map& map) {
  const Eigen::VectorXd& theta = regression.parameters;
  const Eigen::VectorXd value = map(theta);
  Eigen::MatrixXd jacobian(value.size(), theta.size());
  for (Eigen::Index c = 0; c < theta.size(); ++c) {
    const double deviation = std::sqrt(regression.covariance(c, c));
    // A step that is small relative to the value stays in the domain of the map. It is much larger than rounding
    // errors.
    const double step = std::min(deviation, 1e-4 * std::abs(theta(c)) + 1e-300);
    Eigen::VectorXd above = theta, below = theta;
    above(c) += step;
    below(c) -= step;
    jacobian.col(c) = (map(above) - map(below)) / (above(c) - below(c));
  }
  const Eigen::MatrixXd covariance = jacobian * regression.covariance * jacobian.transpose();
  std::vector<Estimate> estimates;
  for (Eigen::Index k = 0; k < value.size(); ++k) {
    const double half = regression.t_quantile * std::sqrt(covariance(k, k));
    estimates.push_back({value(k), {value(k) - half, value(k) + half}});
  }
  return estimates;
}

RigidEstimate from_list(const std::vector<Estimate>& list, const Regression& regression) {
  RigidEstimate estimate;
  estimate.inertia = list[0];
  estimate.viscous = list[1];
  if (list.size() >= 4) {
    estimate.positive = list[2];
    estimate.negative = list[3];
  }
  estimate.condition_number = regression.condition_number;
  estimate.relative_residual = regression.relative_residual;
  estimate.rows = regression.rows;
  return estimate;
}

/// Eqs. (25), (39), (40): physical values from [pwd, Kwd, Kwd d+, Kwd d-].
struct PhysicalFromDiscrete {
  double effort_per_volt, sample_period_s;
  Eigen::VectorXd operator()(const Eigen::VectorXd& theta) const {
    const double pole = theta(0), gain = theta(1);
    const double ratio = std::abs(pole - 1.0) < 1e-9 ? 1.0 : (pole - 1.0) / std::log(pole);  // limit for a pole of 1
    Eigen::VectorXd physical(theta.size());
    physical(0) = ratio * effort_per_volt * sample_period_s / gain;
    physical(1) = (1.0 - pole) * effort_per_volt / gain;
    for (Eigen::Index k = 2; k < theta.size(); ++k) physical(k) = effort_per_volt * theta(k) / gain;
    return physical;
  }
};

std::size_t total_samples(const std::vector<Record>& records) {
  std::size_t rows = 0;
  for (const Record& record : records) rows += record.size();
  return rows;
}

template <int P>
Regression discrete_regression(const std::vector<Record>& records, const sim::DataSheet& data, double deadband) {
  BlockedRegression<P> regression(rows_per_block(total_samples(records), records.front().sample_period_s));
  for (const Record& record : records) {
    const bool volts = !record.u_V.empty();
    const std::vector<double> effort = volts ? std::vector<double>{} : motor_effort(record, data);
    const double* const command = volts ? record.u_V.data() : effort.data();
    const double* const speed = record.w.data();
    const double limit = volts ? data.dac_limit_V : HUGE_VAL;
    const double scale = volts ? 1.0 : 1.0 / data.effort_per_volt();
    regression.add_rows(1, record.size(), [=](std::size_t k, auto&& row) {
      const double before = speed[k - 1];
      row(0) = before;
      row(1) = scale * std::clamp(command[k - 1], -limit, limit);
      if constexpr (P == 4) {
        row(2) = before > deadband ? -1.0 : 0.0;
        row(3) = before < -deadband ? -1.0 : 0.0;
      }
      row(P) = speed[k];
    });
    regression.end_block();
  }
  return regression.solve();
}

constexpr int kCurveTerms = 8;

/// Start and length of the travel of all motions.
std::pair<double, double> travel_of(const std::vector<Motion>& motions) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Motion& motion : motions)
    for (const double x : motion.travel) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  return {low, high - low};
}

/// Regression of inertia and viscous friction (P = 2), with Coulomb friction (4) and a curve over the travel (4 +
/// kCurveTerms).
template <int P>
Regression inverse_regression(const std::vector<Motion>& motions) {
  std::size_t rows = 0;
  for (const Motion& motion : motions) rows += motion.speed.size() / motion.decimation;
  std::pair<double, double> whole_travel;
  if constexpr (P > 4) whole_travel = travel_of(motions);
  const Motion& first = motions.front();
  BlockedRegression<P> regression(rows_per_block(rows, static_cast<double>(first.decimation) / first.sample_rate_Hz));
  for (const Motion& motion : motions) {
    const std::vector<double> effort = motion.seen(motion.effort), acceleration = motion.seen(motion.acceleration),
                              speed = motion.seen(motion.speed);
    std::vector<double> forward, backward;
    std::vector<double> travel;
    if constexpr (P > 4) travel = motion.seen(motion.travel);
    if constexpr (P >= 4) {
      std::vector<double> sign(motion.speed.size());
      for (std::size_t k = 0; k < sign.size(); ++k) sign[k] = motion.speed[k] > 0.0 ? 1.0 : 0.0;
      forward = motion.seen(sign);
      for (std::size_t k = 0; k < sign.size(); ++k) sign[k] = motion.speed[k] < 0.0 ? 1.0 : 0.0;
      backward = motion.seen(sign);
    }
    typename BlockedRegression<P>::Row phi;
    for (std::size_t k = 0; k < effort.size(); ++k) {
      phi(0) = acceleration[k];
      phi(1) = speed[k];
      if constexpr (P >= 4) {
        phi(2) = forward[k];
        phi(3) = backward[k];
      }
      if constexpr (P > 4)
        for (int n = 1; n <= kCurveTerms; ++n)
          phi(3 + n) = std::cos(n * std::numbers::pi * (travel[k] - whole_travel.first) / whole_travel.second);
      regression.add(phi, effort[k]);
    }
    regression.end_block();
  }
  return regression.solve();
}

}  // namespace

RigidEstimate discrete_least_squares(const std::vector<Record>& records, const sim::DataSheet& data, double deadband,
                                     Coulomb coulomb) {
  const PhysicalFromDiscrete physical{data.effort_per_volt(), records.front().sample_period_s};
  const Regression regression = coulomb == Coulomb::estimated ? discrete_regression<4>(records, data, deadband)
                                                              : discrete_regression<2>(records, data, deadband);
  return from_list(map_estimate(regression, physical), regression);
}

RigidEstimate inverse_least_squares(const std::vector<Motion>& motions, Coulomb coulomb) {
  const Regression regression =
      coulomb == Coulomb::estimated ? inverse_regression<4>(motions) : inverse_regression<2>(motions);
  return from_list(map_estimate(regression, [](const Eigen::VectorXd& theta) { return theta; }), regression);
}

RigidEstimate least_squares_beside_travel(const std::vector<Motion>& motions) {
  const Regression regression = inverse_regression<4 + kCurveTerms>(motions);
  return from_list(map_estimate(regression, [](const Eigen::VectorXd& theta) { return theta; }), regression);
}

}  // namespace host
