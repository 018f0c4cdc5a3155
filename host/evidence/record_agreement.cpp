#include "host/evidence/record_agreement.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/evidence/channel_shift.hpp"
#include "host/identify/tachometer.hpp"

namespace host {

namespace {

/// Where a rigid model leaves less than this part of the effort, inertia is known so well that a load which changed
/// by more than kLoad shows.
constexpr double kRigid = 0.03;
constexpr double kLoad = 0.05;
/// Where it leaves more, some effect bends the estimates; a change of scale bends inertia and friction alike.
constexpr double kStillRigid = 0.15;
constexpr double kScale = 0.03;
constexpr double kAlike = 0.02;
/// Part of an inertia's doubt, which supposes the worst, below which its likeness to another factor may be an accident.
constexpr double kLeastKnown = 0.5;
/// Records that agree badly with one another cannot convict one of them.
constexpr double kStandsOut = 3.0;
/// Tachometers agree with the encoder within 0.5 % from record to record.
constexpr double kTachometer = 0.02;

/// The normal equations of the rigid inverse model for one record.
struct RigidEquations {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d cross = Eigen::Vector4d::Zero();
  double total = 0.0;
  std::size_t rows = 0;

  Eigen::Vector4d solve() const { return least_norm_solution(normal, cross); }
  /// Norm of what is left over the norm of the effort.
  double left(const Eigen::Vector4d& theta) const {
    const double squares = total - 2.0 * theta.dot(cross) + theta.dot(normal * theta);
    return total > 0.0 ? std::sqrt(std::max(0.0, squares) / total) : 1.0;
  }
  /// What the effort is of the effort that these parameters ask for.
  double scale_of(const Eigen::Vector4d& theta) const { return theta.dot(cross) / theta.dot(normal * theta); }
  /// By how much of itself the inertia could be off if all that is left looked like acceleration.
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

/// Samples that slide for sure, in both kinds of drive, below a cut-off that short delays and resonances hardly reach.
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

/// Whether inertia takes enough of the effort to be known: a run at constant speed says nothing of it.
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
  // How well the others agree among themselves.
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
    // All of the effort grew by the factor by which the inertia did, which is no accident.
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
    // Where the speed hardly changes, a gain beside an offset is that of the clock's jitter; a scale turns the whole.
    const double whole = std::abs(here->proportion / there->proportion - 1.0);
    if (off < kTachometer || off < kStandsOut * doubt || whole < 0.5 * off) continue;
    if (!worst || off > std::abs(worst->factor - 1.0)) worst = Disagreement{r, &Record::w, factor, false};
  }
  return worst ? worst : rigid_disagreement(by, judged, data);
}

}  // namespace host
