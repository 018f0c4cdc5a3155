#include "host/evidence/record_agreement.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/evidence/channel_shift.hpp"
#include "host/identify/tachometer.hpp"

namespace host {

namespace {

/// If a rigid model leaves less than this part of the torque or force unexplained, the inertia is known well enough to
/// show that the load has changed by more than kLoad.
constexpr double kRigid = 0.03;
constexpr double kLoad = 0.05;
/// Above this part, some effect biases the estimates. Below it, a change of scale shows equally in inertia and
/// friction.
constexpr double kStillRigid = 0.15;
constexpr double kScale = 0.03;
constexpr double kAlike = 0.02;
/// If the inertia deviates by less than this part of its worst-case uncertainty, it may agree with another factor by
/// chance.
constexpr double kLeastKnown = 0.5;
/// If all records disagree with one another, no single record can be called wrong.
constexpr double kStandsOut = 3.0;
/// Tachometer and encoder agree from record to record within 0.5 %.
constexpr double kTachometer = 0.02;

/// The normal equations of the rigid inverse model for one record.
struct RigidEquations {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d cross = Eigen::Vector4d::Zero();
  double total = 0.0;
  std::size_t rows = 0;

  Eigen::Vector4d solve() const { return least_norm_solution(normal, cross); }
  /// Norm of the residual over the norm of the torque or force.
  double left(const Eigen::Vector4d& theta) const {
    const double squares = total - 2.0 * theta.dot(cross) + theta.dot(normal * theta);
    return total > 0.0 ? std::sqrt(std::max(0.0, squares) / total) : 1.0;
  }
  /// Ratio of the torque or force to the value that these parameters predict.
  double scale_of(const Eigen::Vector4d& theta) const { return theta.dot(cross) / theta.dot(normal * theta); }
  /// Relative error of the inertia if the whole residual is proportional to the acceleration.
  double doubt(const Eigen::Vector4d& theta) const {
    const double alone = pseudo_inverse(normal)(0, 0);
    return left(theta) * std::sqrt(total * alone) / std::abs(theta(0));
  }
  RigidEquations& operator+=(const RigidEquations& other) {
    normal += other.normal;
    cross += other.cross;
    total += other.total;
    rows += other.rows;
    return *this;
  }
};

/// Equations from samples in which both kinds of drive slide for certain, below a cut-off frequency at which short
/// delays and resonances hardly matter.
std::optional<RigidEquations> rigid_equations(const Record& record, const sim::DataSheet& data, double top_speed) {
  constexpr double kHighest_Hz = 30.0, kSlow = 0.01;
  constexpr std::size_t kFewestRows = 300;
  MotionOptions options;
  options.cutoff_Hz = std::min({kHighest_Hz, 0.1 / record.sample_period_s, choose_cutoff({record}, data)});
  options.decimation = 1;
  options.deadband = kSlow * top_speed;
  const std::optional<Motion> motion = motion_if_long_enough(record, data, options);
  if (!motion || !(top_speed > 0.0)) return std::nullopt;
  RigidEquations equations;
  for (std::size_t k = 0; k < motion->speed.size(); ++k) {
    if (!motion->counts[k]) continue;
    const double w = motion->speed[k];
    const Eigen::Vector4d phi(motion->acceleration[k], w, w > 0.0 ? 1.0 : 0.0, w < 0.0 ? 1.0 : 0.0);
    equations.normal += phi * phi.transpose();
    equations.cross += phi * motion->effort[k];
    equations.total += motion->effort[k] * motion->effort[k];
    ++equations.rows;
  }
  if (equations.rows < kFewestRows) return std::nullopt;
  return equations;
}

/// Whether the inertia needs enough of the torque or force to be identified; at constant speed it does not.
bool accelerates(const RigidEquations& equations, const Eigen::Vector4d& theta) {
  constexpr double kShare = 0.05;
  return std::sqrt(equations.normal(0, 0)) * std::abs(theta(0)) > kShare * std::sqrt(equations.total);
}

double top_speed_of(const std::vector<const Record*>& records, const sim::DataSheet& data) {
  constexpr double kSmooth_Hz = 10.0;
  double top = 0.0;
  for (const Record* record : records) {
    const double cutoff_Hz = std::min(kSmooth_Hz, 0.1 / record->sample_period_s);
    for (const double w : smooth_speed(*record, data, cutoff_Hz)) top = std::max(top, std::abs(w));
  }
  return top;
}

std::optional<Disagreement> rigid_disagreement(const std::vector<const Record*>& by,
                                               const std::vector<const Record*>& judged, const sim::DataSheet& data) {
  const double top_speed = top_speed_of(by, data);
  struct Known {
    const Record* record;
    RigidEquations equations;
  };
  std::vector<Known> known;
  for (const Record* record : by)
    if (const auto equations = rigid_equations(*record, data, top_speed)) known.push_back({record, *equations});
  const auto others = [&](const Record* record) {
    RigidEquations sum;
    for (const Known& other : known)
      if (other.record != record) sum += other.equations;
    return sum;
  };
  // How well the other records agree with one another.
  const auto spread = [&](const Record* judged_record) {
    double largest = 0.0;
    for (const Known& one : known) {
      if (one.record == judged_record) continue;
      RigidEquations rest;
      for (const Known& other : known)
        if (other.record != one.record && other.record != judged_record) rest += other.equations;
      if (rest.rows == 0 || !accelerates(one.equations, one.equations.solve())) continue;
      largest = std::max(largest, std::abs(one.equations.solve()(0) / rest.solve()(0) - 1.0));
    }
    return largest;
  };
  std::optional<Disagreement> worst;
  for (std::size_t r = 0; r < judged.size(); ++r) {
    const auto own = rigid_equations(*judged[r], data, top_speed);
    const RigidEquations rest = others(judged[r]);
    if (!own || rest.rows == 0) continue;
    const Eigen::Vector4d here = own->solve(), there = rest.solve();
    if (!accelerates(*own, here) || !accelerates(rest, there) || !(there(0) > 0.0)) continue;
    const double inertia = here(0) / there(0), off = std::abs(inertia - 1.0);
    const double left = std::max(own->left(here), rest.left(there));
    const double scale = own->scale_of(there);
    const auto alike = [&](Eigen::Index k) { return std::abs(here(k) / there(k) / inertia - 1.0) < kAlike; };
    const bool friction_too = alike(2) && alike(3);
    const double doubt = own->doubt(here) + rest.doubt(there);
    const bool another_load = left < kRigid && off > std::max(kLoad, doubt);
    // The whole torque or force changed by the same factor as the inertia, which is not by chance.
    const bool by_one_factor = std::abs(inertia / scale - 1.0) < kAlike;
    const bool all_of_it = left < kRigid && std::abs(scale - 1.0) > std::max(kScale, 2.0 * left) && by_one_factor &&
                           off > kLeastKnown * doubt;
    const bool another_scale = all_of_it || (left < kStillRigid && off > kScale && friction_too);
    if ((!another_load && !another_scale) || off < kStandsOut * spread(judged[r])) continue;
    if (worst && std::abs(worst->factor - 1.0) >= off) continue;
    const auto channel = judged[r]->u_V.empty() ? &Record::i_A : &Record::u_V;
    worst = Disagreement{r, channel, all_of_it ? scale : inertia, another_scale};
  }
  return worst;
}

}  // namespace

std::optional<Disagreement> record_disagreement(const std::vector<const Record*>& by,
                                                const std::vector<const Record*>& judged, const sim::DataSheet& data) {
  std::optional<Disagreement> worst;
  for (std::size_t r = 0; r < judged.size(); ++r) {
    std::vector<Record> rest;
    for (const Record* record : by)
      if (record != judged[r]) rest.push_back(*record);
    const auto here = calibrate_tachometer({*judged[r]}, data), there = calibrate_tachometer(rest, data);
    if (!here || !there) continue;
    const double factor = here->gain.value / there->gain.value, off = std::abs(factor - 1.0);
    const double doubt = here->gain.half_width() + there->gain.half_width();
    // If the speed hardly changes, clock jitter looks like a gain with an offset. A wrong scale changes the whole
    // signal.
    const double whole = std::abs(here->proportion / there->proportion - 1.0);
    if (off < kTachometer || off < kStandsOut * doubt || whole < 0.5 * off) continue;
    if (!worst || off > std::abs(worst->factor - 1.0)) worst = Disagreement{r, &Record::w, factor, false};
  }
  return worst ? worst : rigid_disagreement(by, judged, data);
}

}  // namespace host
