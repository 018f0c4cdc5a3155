#include "host/effort/effort_compliance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/cancellation.hpp"
#include "sim/catalogue.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A load behind a spring whose motor end moves as recorded.
struct Load {
  double resonance_Hz;  ///< with the motor held: the antiresonance that the motor sees
  double damping;
  double friction;  ///< Coulomb friction over inertia, rad/s^2 or m/s^2
};

/// The spring's pull over the load's inertia: w^2 d + 2 z w d', d'' = a - pull + friction sign(load's speed), d: the
/// twist. Semi-implicit steps of an eighth of a radian; friction takes speed away at most, and then holds.
VectorXd pull_of(const EffortRows& rows, const Load& load) {
  VectorXd column(rows.w.size());
  const double omega = 2.0 * std::numbers::pi * load.resonance_Hz, damping = 2.0 * load.damping * omega;
  for (const EffortSignals& signals : rows.signals) {
    const auto parts = static_cast<int>(std::ceil(omega * signals.period_s / 0.125));
    const double step = signals.period_s / parts, hold = step * load.friction;
    double speed = signals.speed.empty() ? 0.0 : signals.speed.front(), twist = 0.0;
    std::size_t next = 0;
    for (std::size_t k = 0; k < signals.speed.size() && next < signals.kept.size(); ++k) {
      if (signals.kept[next] == k)
        column(static_cast<Index>(signals.first_row + next++)) =
            omega * omega * twist + damping * (signals.speed[k] - speed);
      if (k + 1 == signals.speed.size()) break;
      const double slope = (signals.speed[k + 1] - signals.speed[k]) / signals.period_s;
      for (int part = 0; part < parts; ++part) {
        const double motor = signals.speed[k] + slope * step * (part + 0.5);
        const double moved = speed + step * (omega * omega * twist + damping * (motor - speed));
        speed = moved > hold ? moved - hold : (moved < -hold ? moved + hold : 0.0);
        twist += step * (motor - speed);
      }
    }
  }
  return column;
}

EffortTerm compliance_term(const EffortRows& rows, const Load& load) {
  EffortTerm term{"compliance", pull_of(rows, load), {1}, {}, {}};
  // A load that its friction holds is a hysteresis (a cable chain, a seal), whatever mass it has.
  constexpr double kHeld = 0.7;  // of the RMS pull
  const double pull = std::sqrt(term.columns.squaredNorm() / static_cast<double>(term.columns.rows()));
  const bool held = load.friction > kHeld * pull;
  // Frequency and damping with the motor held become those of both masses, free to move.
  term.write = [load, held](const VectorXd& factors, sim::DriveDescription& fitted) {
    sim::EffectEntry& inertia = *fitted.find("inertia");
    const double whole = inertia.at("J") + factors(0), share = factors(0) / whole;
    if (held || !(share > 0.0) || !(share < 1.0)) return false;
    const double ratio = 1.0 / std::sqrt(1.0 - share), on_load = load.friction * factors(0);
    constexpr double kSwings = 0.71;  // with more damping nothing resounds, and a spring stands for something else
    if (load.damping * ratio > kSwings) return false;
    inertia.parameters["J"] = whole;
    double part = 0.0;
    if (sim::EffectEntry* coulomb = fitted.find("coulomb"); coulomb != nullptr && on_load > 0.0) {
      // The regression's level is the motor's own; the model's is that of both.
      double level = 0.0;
      for (const auto& [id, value] : coulomb->parameters)
        level += std::abs(value) / static_cast<double>(coulomb->parameters.size());
      part = on_load / (on_load + level);
      for (auto& [id, value] : coulomb->parameters) value += value < 0.0 ? -on_load : on_load;
    }
    sim::EffectEntry entry;
    entry.kind = "compliance";
    entry.parameters = {{"resonance", load.resonance_Hz * ratio},
                        {"damping_ratio", std::clamp(load.damping * ratio, 0.001, 1.0)},
                        {"load_fraction", share},
                        {"load_friction", part}};
    return append_within_bounds(fitted, std::move(entry));
  };
  term.words = fmt::format("antiresonance {:.3g} Hz{}", load.resonance_Hz,
                           load.friction > 0.0 ? ", friction on both sides" : "");
  term.neighbours = [&rows, load](double part) {
    std::vector<EffortTerm> around;
    // Damping and friction show far less than the frequency.
    constexpr double kCoarser = 6.0;
    for (const double sign : {-1.0, 1.0}) {
      const double factor = std::exp(sign * part), coarse = std::exp(sign * kCoarser * part);
      around.push_back(compliance_term(rows, {factor * load.resonance_Hz, load.damping, load.friction}));
      around.push_back(compliance_term(rows, {load.resonance_Hz, coarse * load.damping, load.friction}));
      if (load.friction > 0.0)
        around.push_back(compliance_term(rows, {load.resonance_Hz, load.damping, coarse * load.friction}));
    }
    return around;
  };
  term.at_frequency = [&rows, load](double factor) {
    return compliance_term(rows, {factor * load.resonance_Hz, load.damping, load.friction});
  };
  return term;
}

}  // namespace

void append_compliance(const sim::DriveDescription& model, const EffortRows& rows, std::vector<EffortTerm>& terms) {
  if (rows.steady) return;  // without acceleration a second mass does not show
  constexpr double kLowest_Hz = 1.0, kStep = 1.12, kShareOfCutoff = 0.8;
  sim::DriveDescription base = model;
  std::erase_if(base.effects, [](const sim::EffectEntry& entry) { return !sim::find_effect(entry.kind)->base; });
  const sim::Drive drive(base);
  const double usual = 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb) / drive.inertia;
  const double span = std::log(kShareOfCutoff * rows.lowest_cutoff_Hz / kLowest_Hz);
  constexpr double kMost = 100.0;  // up to 90 kHz
  const auto frequencies = static_cast<int>(std::ceil(std::clamp(span / std::log(kStep), 0.0, kMost)));
  for (int k = 0; k < frequencies; ++k) {
    const double resonance_Hz = kLowest_Hz * std::pow(kStep, k);
    throw_if_cancelled();
    for (const double damping : {0.02, 0.1, 0.3}) terms.push_back(compliance_term(rows, {resonance_Hz, damping, 0.0}));
    if (usual > 0.0)
      for (const double part : {0.25, 0.5, 1.0, 2.0, 4.0})
        terms.push_back(compliance_term(rows, {resonance_Hz, 0.05, part * usual}));
  }
}

}  // namespace host
