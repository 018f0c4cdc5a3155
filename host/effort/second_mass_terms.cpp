#include "host/effort/second_mass_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <type_traits>
#include <utility>

#include "host/identify/zero_phase_filter.hpp"
#include "host/parallel.hpp"
#include "sim/catalogue.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kGapStep = 1.5;  ///< ratio of successive widths of the gap that are tried

/// A load on a spring. The motor end of the spring follows the recorded motion.
struct Load {
  double resonance_Hz;  ///< resonance with the motor held, which is the motor's antiresonance
  double damping;
  double friction;         ///< Coulomb friction over inertia, rad/s^2 or m/s^2
  double gap = 0.0;        ///< free travel, rad or m
  double least_gap = 0.0;  ///< smallest gap that the encoder shows; a smaller one is a spring
};

/// The loads that are integrated side by side.
constexpr std::size_t kSideBySide = EightSamples::RowsAtCompileTime;

/// Force of the coupling over the inertia of the load, at every sample: w^2 d + 2 z w d', where d is the twist beyond
/// the gap and d'' = a - pull + friction sign(load's speed). With a gap, the contact pushes and never pulls
/// (sim/coupling.hpp). Semi-implicit integration with steps of an eighth of a radian. Friction can only slow the load
/// down to rest and then holds it. `Sample`: a number for one load, EightSamples for at most eight with the same
/// resonance, either all with a gap or all without one.
template <typename Sample>
std::vector<Sample> pulls_over(const EffortSignals& signals, std::span<const Load> loads) {
  std::vector<Sample> pulls(signals.speed.size());
  const double omega = 2.0 * std::numbers::pi * loads.front().resonance_Hz, square = omega * omega;
  const bool has_gap = loads.front().gap > 0.0;
  const auto parts = static_cast<int>(std::ceil(omega * signals.period_s / 0.125));
  const double step = signals.period_s / parts;
  const auto of_each = [&](auto value) {
    if constexpr (std::is_same_v<Sample, double>)
      return value(loads.front());
    else {
      Sample values = Sample::Zero();
      for (std::size_t k = 0; k < kSideBySide; ++k)
        values(static_cast<Index>(k)) = value(loads[std::min(k, loads.size() - 1)]);
      return values;
    }
  };
  const auto limited = [](const Sample& value, const Sample& least, const Sample& most) -> Sample {
    if constexpr (std::is_same_v<Sample, double>)
      return std::min(std::max(value, least), most);
    else
      return value.max(least).min(most);
  };
  const Sample damping = of_each([&](const Load& load) { return 2.0 * load.damping * omega; });
  const Sample hold = of_each([&](const Load& load) { return step * load.friction; });
  const Sample half_gap = of_each([](const Load& load) { return 0.5 * load.gap; });
  const Sample zero = of_each([](const Load&) { return 0.0; });
  Sample twist = zero, speed = zero;
  if (!signals.speed.empty()) speed += signals.speed.front();
  const auto pull_at = [&](double motor) -> Sample {
    if (!has_gap) return square * twist + damping * (motor - speed);
    constexpr double kUnlimited = 1e300;  // times the twist beyond the gap: in the gap both limits are 0
    const Sample beyond = twist - limited(twist, -half_gap, half_gap);
    return limited(square * beyond + damping * (motor - speed), kUnlimited * limited(beyond, beyond, zero),
                   kUnlimited * limited(beyond, zero, beyond));
  };
  for (std::size_t k = 0; k < signals.speed.size(); ++k) {
    pulls[k] = pull_at(signals.speed[k]);
    if (k + 1 == signals.speed.size()) break;
    const double slope = (signals.speed[k + 1] - signals.speed[k]) / signals.period_s;
    for (int part = 0; part < parts; ++part) {
      const double motor = signals.speed[k] + slope * step * (part + 0.5);
      const Sample moved = speed + step * pull_at(motor);
      speed = moved - limited(moved, -hold, hold);
      twist += step * (motor - speed);
    }
  }
  return pulls;
}

/// The pulls of one load, or of several (see pulls_over), a column each.
template <typename Sample>
MatrixXd pulls_of(const EffortRows& rows, std::span<const Load> loads) {
  MatrixXd columns(rows.w.size(), static_cast<Index>(loads.size()));
  const bool is_rough = std::ranges::any_of(loads, [](const Load& one) { return one.gap > 0.0 || one.friction > 0.0; });
  for (const EffortSignals& signals : rows.signals) {
    const std::vector<Sample> pulls = pulls_over<Sample>(signals, loads);
    // The coupling force of a free load is as smooth as the motion. With impacts or stiction it is not, so it gets the
    // same filter as the torque or force.
    std::vector<Sample> smooth;
    if (is_rough)
      smooth = ZeroPhaseLowPass::butterworth(signals.cutoff_Hz, 1.0 / signals.period_s)(std::span<const Sample>(pulls));
    for (std::size_t k = 0; k < signals.kept.size(); ++k) {
      const auto row = static_cast<Index>(signals.first_row + k);
      for (std::size_t c = 0; c < loads.size(); ++c) {
        const auto column = static_cast<Index>(c);
        const bool filters = loads[c].gap > 0.0 || loads[c].friction > 0.0;
        const Sample& sample = (filters ? smooth : pulls)[signals.kept[k]];
        if constexpr (std::is_same_v<Sample, double>)
          columns(row, column) = sample;
        else
          columns(row, column) = sample(column);
      }
    }
  }
  return columns;
}

EffortTerm term_of(const EffortRows& rows, const Load& load, const char* unit);

/// The term of a load with this pull.
EffortTerm term_of(const EffortRows& rows, const Load& load, const char* unit, MatrixXd pulls) {
  EffortTerm term{load.gap > 0.0 ? "backlash" : "compliance", std::move(pulls), {1}, {}, {}};
  // A load that is held by its own friction acts as a hysteresis (a cable chain, a seal), and its mass does not matter.
  constexpr double kHeld = 0.7;  // of the RMS pull
  const double pull = std::sqrt(term.columns.squaredNorm() / static_cast<double>(term.columns.rows()));
  const bool held = load.friction > kHeld * pull;
  // Converts frequency and damping with the motor held to those of motor and load free to move.
  term.write = [load, held, lead = rows.lead](const VectorXd& factors, sim::DriveDescription& fitted) {
    sim::EffectEntry& inertia = *fitted.find("inertia");
    const double whole = inertia.at("J") + factors(0), share = factors(0) / whole;
    if (held || !(share > 0.0) || !(share < 1.0)) return false;
    const double ratio = 1.0 / std::sqrt(1.0 - share), on_load = load.friction * factors(0);
    inertia.parameters["J"] = whole;
    double part = 0.0;
    if (sim::EffectEntry* coulomb = fitted.find("coulomb"); coulomb != nullptr && on_load > 0.0) {
      // The friction level of the regression is that of the motor alone; the level in the model is that of motor and
      // load.
      double level = 0.0;
      for (const auto& [id, value] : coulomb->parameters)
        level += std::abs(value) / static_cast<double>(coulomb->parameters.size());
      part = on_load / (on_load + level);
      for (auto& [id, value] : coulomb->parameters) value += value < 0.0 ? -on_load : on_load;
    }
    sim::EffectEntry entry;
    entry.kind = load.gap > 0.0 ? "backlash" : "compliance";
    entry.parameters = {{"resonance", load.resonance_Hz * ratio},
                        {"damping_ratio", std::clamp(load.damping * ratio, 0.001, 1.0)},
                        {"load_fraction", share},
                        {"load_friction", part},
                        {"load_viscous", 0.0}};
    if (load.gap > 0.0) entry.parameters["gap"] = load.gap * lead;
    return append_within_bounds(fitted, std::move(entry));
  };
  // With more damping there is no resonance, and the spring stands in for another effect. A load with impacts may have
  // any damping. The search for the closest form may pass this limit, because a form that ends at the limit is not a
  // spring either.
  if (load.gap <= 0.0)
    term.is_itself = [](const sim::DriveDescription& fitted) {
      const double swings = 1.0 / std::numbers::sqrt2;  // above it the response has no maximum
      return fitted.find("compliance")->at("damping_ratio") < swings;
    };
  if (load.gap > 0.0)
    term.words = fmt::format("free travel {:.3g} {}{}", load.gap * rows.lead, unit,
                             load.friction > 0.0 ? ", friction on both sides" : "");
  else
    term.words = fmt::format("antiresonance {:.3g} Hz{}", load.resonance_Hz,
                             load.friction > 0.0 ? ", friction on both sides" : "");
  if (load.gap > 0.0 && load.gap < kGapStep * load.least_gap)
    term.contained = [&rows, load, unit] {
      Load spring = load;
      spring.gap = spring.least_gap = 0.0;
      return term_of(rows, spring, unit);
    };
  term.neighbours = [&rows, load, unit](double part) {
    std::vector<std::function<EffortTerm()>> around;
    // Damping and friction are much less visible than the frequency; with a gap, the frequency is also hardly visible.
    constexpr double kCoarser = 6.0;
    for (const double sign : {-1.0, 1.0}) {
      const double fine = std::exp(sign * part), coarse = std::exp(sign * kCoarser * part);
      const auto moved = [&](double Load::*parameter, double factor) {
        Load other = load;
        other.*parameter *= factor;
        if (other.gap >= load.least_gap) around.push_back([&rows, other, unit] { return term_of(rows, other, unit); });
      };
      if (load.gap > 0.0) moved(&Load::gap, fine);
      moved(&Load::resonance_Hz, load.gap > 0.0 ? coarse : fine);
      moved(&Load::damping, coarse);
      if (load.friction > 0.0) moved(&Load::friction, coarse);
    }
    return around;
  };
  return term;
}

/// Loads that follow one another and can be integrated side by side.
struct Group {
  std::size_t first, count;
};

std::vector<Group> side_by_side(const std::vector<Load>& loads) {
  std::vector<Group> groups;
  for (std::size_t first = 0; first < loads.size();) {
    const Load& load = loads[first];
    std::size_t count = 1;
    while (count < kSideBySide && first + count < loads.size() &&
           loads[first + count].resonance_Hz == load.resonance_Hz &&
           (loads[first + count].gap > 0.0) == (load.gap > 0.0))
      ++count;
    groups.push_back({first, count});
    first += count;
  }
  return groups;
}

EffortTerm term_of(const EffortRows& rows, const Load& load, const char* unit) {
  return term_of(rows, load, unit, pulls_of<double>(rows, {&load, 1}));
}

}  // namespace

double least_gap(const sim::DataSheet& data) {
  constexpr double kFewCounts = 4.0;
  return kFewCounts * data.encoder_resolution;
}

std::vector<EffortTerm> second_mass_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                          const std::vector<std::string>& absent) {
  const auto may_be = [&](const char* kind) { return std::ranges::find(absent, kind) == absent.end(); };
  for (const char* contact : {"compliance", "backlash", "presliding"})
    if (model.find(contact) != nullptr) return {};
  if (rows.steady) return {};  // without acceleration a second mass is not visible
  // A resonance above the cut-off is still visible as a deflection in proportion to the force.
  constexpr double kLowest_Hz = 1.0, kStep = 1.12, kShareOfCutoff = 0.8, kBeyond = 2.0;
  sim::DriveDescription base = model;
  std::erase_if(base.effects, [](const sim::EffectEntry& entry) { return !sim::find_effect(entry.kind)->base; });
  const sim::Drive drive(base);
  const double usual = 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb) / drive.inertia;
  const double highest_Hz = kShareOfCutoff * rows.lowest_cutoff_Hz, span = std::log(kBeyond * highest_Hz / kLowest_Hz);
  constexpr double kMost = 100.0;  // up to 90 kHz
  const auto frequencies = static_cast<int>(std::ceil(std::clamp(span / std::log(kStep), 0.0, kMost)));
  std::vector<Load> loads;
  for (int k = 0; k < frequencies && may_be("compliance"); ++k) {
    const double resonance_Hz = kLowest_Hz * std::pow(kStep, k);
    for (const double damping : {0.02, 0.1, 0.3}) loads.push_back({resonance_Hz, damping, 0.0});
    if (usual > 0.0)
      for (const double part : {0.25, 0.5, 1.0, 2.0, 4.0}) loads.push_back({resonance_Hz, 0.05, part * usual});
  }
  // Gaps from a few counts of the encoder to the catalogue's bound, but at most a twentieth of the travel. The contact
  // is stiff, because motion above the cut-off is not visible. It is well damped, because a motion with a resolution of
  // one count does not show the times of bounces.
  if (rows.has_position && may_be("backlash")) {
    const sim::ParameterInfo& gap = *sim::find_effect("backlash")->parameter("gap");
    constexpr double kOfTravel = 0.05;
    const double most = std::min(gap.upper, kOfTravel * (rows.x.maxCoeff() - rows.x.minCoeff()));
    const double least = least_gap(model.data);
    for (double free = least; free > 0.0 && free <= most; free *= kGapStep)
      for (const double resonance_Hz : {0.5 * highest_Hz, highest_Hz, kBeyond * highest_Hz})
        for (const double damping : {0.3, 0.6})
          for (const double part : {0.15, 0.5, 1.5})
            loads.push_back({resonance_Hz, damping, part * usual, free / rows.lead, least / rows.lead});
  }
  const char* const unit = model.data.kind == sim::DriveKind::rotary ? "mm" : "m";
  std::vector<EffortTerm> terms(loads.size());
  const std::vector<Group> groups = side_by_side(loads);
  for_each_in_parallel(groups.size(), [&](std::size_t k) {
    const auto [first, count] = groups[k];
    const MatrixXd pulls = pulls_of<EightSamples>(rows, std::span(loads).subspan(first, count));
    for (std::size_t c = 0; c < count; ++c)
      terms[first + c] = term_of(rows, loads[first + c], unit, pulls.col(static_cast<Index>(c)));
  });
  return terms;
}

}  // namespace host
