#include "host/diagnose/visibility.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/dense_solutions.hpp"
#include "host/fit/parameter_vector.hpp"
#include "host/parallel.hpp"
#include "host/search/candidate_starts.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

constexpr std::size_t kWindows = 100;
/// At most this many starts of an effect are tried, evenly spread.
constexpr std::size_t kMostSizes = 4;
/// Difference step of the derivatives, relative to a parameter's scale.
constexpr double kStep = 1e-3;
/// Period of a ripple on a linear drive, whose model has no screw: the pitch of a usual screw.
constexpr double kUsualPitch_m = 0.01;
/// Usual amplitudes of ripples: cogging and friction along the travel relative to the Coulomb level, ripple of the
/// torque constant and of the tachometer relative to their mean, an encoder's error in micrometres.
constexpr double kUsualCogging = 0.05, kUsualFrictionWave = 0.15, kUsualRipple = 0.03, kUsualEncoderError_um = 5.0;

RecordSet few_windows(const RecordSet& set) {
  RecordSet few = set;
  few.stride = 1;
  few.stride = std::max<std::size_t>(1, few.used_windows() / kWindows);
  few.common_square = 1e12;  // differences of predictions, which have no outliers
  return few;
}

/// Errors over noise floor of all samples of both sets, scaled so that the sum of their squares is the mean square
/// error.
Eigen::VectorXd errors_of(const sim::DriveDescription& model, const std::array<RecordSet, 2>& sets) {
  const auto first = static_cast<Eigen::Index>(residual_count(sets[0]));
  const auto second = static_cast<Eigen::Index>(residual_count(sets[1]));
  Eigen::VectorXd errors(first + second);
  const sim::Drive drive(model);
  residuals_of(drive, sets[0], errors.data());
  residuals_of(drive, sets[1], errors.data() + first);
  return errors * std::numbers::sqrt2 / 2.0;
}

std::vector<sim::DriveDescription> usual_sizes(const sim::EffectInfo& info, const sim::DriveDescription& base,
                                               const RecordSet& set) {
  std::vector<sim::DriveDescription> all;
  if (info.periodic) {
    const sim::Drive drive(base);
    const bool rotary = base.data.kind == sim::DriveKind::rotary;
    const RecordScales scales = scales_of(set);
    const double coulomb = 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb);
    const bool slow = info.kind == "position_dependent_friction";
    const double amplitude = slow                                ? kUsualFrictionWave
                             : info.kind == "cogging"            ? kUsualCogging * coulomb
                             : info.stage == sim::Stage::encoder ? kUsualEncoderError_um * (rotary ? 1e-3 : 1e-6)
                                                                 : kUsualRipple;
    const double period = slow     ? scales.travel
                          : rotary ? base.data.turn()
                                   : std::min(kUsualPitch_m, 0.1 * scales.travel);
    all.push_back(base);
    all.back().effects.push_back(
        {std::string(info.kind), {{"cosine", amplitude}, {"sine", 0.0}, {"period", period}}, {}, {}});
    return all;
  }
  all = starting_models(info, base, set);
  if (all.size() <= kMostSizes) return all;
  std::vector<sim::DriveDescription> chosen;
  for (std::size_t k = 0; k < kMostSizes; ++k) chosen.push_back(all[k * (all.size() - 1) / (kMostSizes - 1)]);
  return chosen;
}

}  // namespace

std::vector<Visibility> visibility_of_effects(const sim::DriveDescription& base, const RecordSet& training,
                                              const RecordSet& validation) {
  const std::array sets{few_windows(training), few_windows(validation)};
  const Eigen::VectorXd here = errors_of(base, sets);
  const ParameterVector vector(base);
  Eigen::MatrixXd slopes(here.size(), static_cast<Eigen::Index>(vector.size()));
  const Eigen::VectorXd values = vector.read(base);
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    Eigen::VectorXd moved = values;
    moved(k) += kStep * vector.parameters()[static_cast<std::size_t>(k)].scale;
    sim::DriveDescription model = base;
    vector.write(moved, model);
    slopes.col(k) = (errors_of(model, sets) - here) / kStep;
  }
  const auto refit = least_norm_solver(slopes);

  std::vector<const sim::EffectInfo*> infos;
  for (const sim::EffectInfo* info : sim::catalogue())
    if (is_applicable(*info, base, training)) infos.push_back(info);
  std::vector<Visibility> seen(infos.size());
  for_each_in_parallel(infos.size(), [&](std::size_t k) {
    seen[k].kind = infos[k]->kind;
    for (const sim::DriveDescription& model : usual_sizes(*infos[k], base, training)) {
      const Eigen::VectorXd trace = errors_of(model, sets) - here;
      if (!trace.allFinite()) continue;
      seen[k].floors = std::max(seen[k].floors, (trace - slopes * refit(trace)).norm());
    }
  });
  return seen;
}

}  // namespace host
