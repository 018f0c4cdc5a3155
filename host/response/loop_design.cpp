#include "host/response/loop_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/core/control/pole_check.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/axis_parameters.hpp"

namespace host {

namespace {

constexpr double kLowest_Hz = 3.0;
constexpr double kHighestShare = 0.12;  ///< of the control rate: what pole placement on a rigid drive is good for
constexpr double kStep = 1.04;
/// A notch is tried on the resonance and beside it (nearer to the crossover it turns the phase less), of these shapes.
constexpr std::array kPlaces = {0.9, 1.0, 1.12};
constexpr std::array kDampings = {0.15, 0.3, 0.6};
constexpr std::array kDepths = {0.05, 0.2, 0.45};

class Search {
 public:
  Search(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
         const AxisResponse& measured)
      : model_(model), options_(options), aim_(aim), drive_(fine_plant(measured.response, *measured.fit)) {}

  firmware::AxisParameters<float> parameters(double bandwidth_Hz, const ControlFilterChoice& filters) const {
    return designed_parameters(model_, design(bandwidth_Hz), filters);
  }

  AxisDesign design(double bandwidth_Hz) const {
    DesignOptions options = options_;
    options.bandwidth_Hz = bandwidth_Hz;
    return design_axis(model_, options);
  }

  /// The highest bandwidth that keeps the aim; 0 where none does.
  double highest(const ControlFilterChoice& filters) {
    double best = 0.0;
    for (double f = kLowest_Hz; f < kHighestShare / model_.data.sample_period_s; f *= kStep)
      if (keeps(parameters(f, filters))) best = f;
    return best;
  }

  double best_modulus() const { return best_modulus_; }

 private:
  bool keeps(const firmware::AxisParameters<float>& parameters) {
    if (firmware::check_poles(parameters) != firmware::Refusal::none) return false;
    const LoopMargins margins = quick_margins(drive_, AxisController(parameters));
    if (!margins.is_stable || !margins.modulus) return false;
    best_modulus_ = std::max(best_modulus_, margins.modulus->value);
    if (aim_.crossover_Hz && margins.crossover_Hz && margins.crossover_Hz->value > *aim_.crossover_Hz) return false;
    return !aim_.modulus || margins.modulus->value >= *aim_.modulus;
  }

  const sim::DriveDescription& model_;
  const DesignOptions& options_;
  const LoopAim& aim_;
  FinePlant drive_;
  double best_modulus_ = 0.0;
};

/// Every notch that is worth a try.
std::vector<ControlFilterChoice> choices(const LoopAim& aim, const PlantFit& fit, double sample_period_s) {
  std::vector<ControlFilterChoice> list = {aim.filters};
  if (!aim.seek_notch) return list;
  for (const Resonance& mode : fit.resonances)
    for (const double place : kPlaces)
      for (const double damping : kDampings)
        for (const double depth : kDepths) {
          const double f_Hz = place * mode.f_Hz.value;
          if (f_Hz * sample_period_s >= 0.44) continue;
          ControlFilterChoice choice = aim.filters;
          choice.notch = Notch{f_Hz, damping, depth};
          list.push_back(choice);
        }
  return list;
}

}  // namespace

LoopDesign design_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                       const AxisResponse& measured) {
  if (!measured.fit) throw Failure(ExitCode::refused, "too few frequencies were measured to design on them");
  Search search(model, options, aim, measured);
  double bandwidth_Hz = options.bandwidth_Hz;
  ControlFilterChoice filters = aim.filters;
  if (aim.modulus || aim.crossover_Hz) {
    bandwidth_Hz = 0.0;
    for (const ControlFilterChoice& choice : choices(aim, *measured.fit, model.data.sample_period_s))
      if (const double found = search.highest(choice); found > bandwidth_Hz) {
        bandwidth_Hz = found;
        filters = choice;
      }
    if (bandwidth_Hz == 0.0)
      throw Failure(ExitCode::refused, fmt::format("no bandwidth keeps this on the measured response: the largest "
                                                   "modulus margin that there is is {:.3g}",
                                                   search.best_modulus()));
  } else if (aim.seek_notch && !measured.fit->resonances.empty()) {
    filters.notch = Notch{measured.fit->resonances.front().f_Hz.value};
  }
  const AxisDesign plain = design_axis(model, options);
  AxisDesign tuned = search.design(bandwidth_Hz);
  const AxisResponse after = with_controller(measured, designed_parameters(model, tuned, filters));
  return {std::move(tuned), filters, with_controller(measured, designed_parameters(model, plain)), after};
}

}  // namespace host
