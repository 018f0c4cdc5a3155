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
constexpr double kHighestShare = 0.12;  ///< of the control rate: highest bandwidth for pole placement on a rigid drive
/// Frequencies relative to the resonance at which a notch is tried: farther from the crossover it costs less phase.
constexpr std::array kPlaces = {0.9, 1.0, 1.12};
constexpr std::array kDampings = {0.15, 0.3, 0.6};
constexpr std::array kDepths = {0.05, 0.2, 0.45};

AxisDesign design_at(const LoopTask& drive, double bandwidth_Hz) {
  DesignOptions options = drive.options;
  options.bandwidth_Hz = bandwidth_Hz;
  return design_axis(drive.model, options);
}

/// Whether the loop meets the requirements. If it is stable, also lowers `best_modulus` to this drive's modulus margin.
bool keeps(const LoopTask& drive, const LoopAim& aim, const ControlFilterChoice& filters, double bandwidth_Hz,
           double& best_modulus) {
  const auto parameters = designed_parameters(drive.model, design_at(drive, bandwidth_Hz), filters);
  LoopMargins margins;
  margins.is_stable = firmware::check_poles(parameters) == firmware::Refusal::none;
  if (margins.is_stable) margins = quick_margins(drive.drive, AxisController(parameters));
  if (!margins.is_stable || !margins.modulus) {
    best_modulus = 0.0;
    return false;
  }
  best_modulus = std::min(best_modulus, margins.modulus->value);
  if (aim.crossover_Hz && margins.crossover_Hz && margins.crossover_Hz->value > *aim.crossover_Hz) return false;
  return !aim.modulus || margins.modulus->value >= *aim.modulus;
}

}  // namespace

HighestLoop highest_bandwidth(const std::vector<LoopTask>& drives, const LoopAim& aim,
                              const ControlFilterChoice& filters) {
  HighestLoop found;
  std::size_t widest = 0, width = 0;  // of ranges of bandwidths that meet the requirements, in steps
  const double period_s = drives.front().model.data.sample_period_s;
  for (double f = kLowest_Hz; f < kHighestShare / period_s; f *= kBandwidthStep) {
    double modulus = HUGE_VAL;
    std::vector<std::size_t> stopped_by;
    for (std::size_t i = 0; i < drives.size(); ++i)
      if (!keeps(drives[i], aim, filters, f, modulus)) stopped_by.push_back(i);
    found.best_modulus = std::max(found.best_modulus, modulus);
    if (!stopped_by.empty()) {
      const bool is_end_of_widest = width > 0 && width == widest && found.stopped_by.empty();
      if (is_end_of_widest || (widest == 0 && found.stopped_by.empty())) found.stopped_by = stopped_by;
      width = 0;
    } else if (++width > widest) {
      widest = width;
      found.bandwidth_Hz = f;
      found.stopped_by.clear();
    }
  }
  return found;
}

std::vector<ControlFilterChoice> filter_choices(const LoopAim& aim, const PlantFit& fit, double sample_period_s) {
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

LoopDesign design_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                       const AxisResponse& measured) {
  if (!measured.fit) throw Failure(ExitCode::refused, "too few frequencies were measured to design on them");
  const FinePlant fine = fine_plant(measured.response, *measured.fit);
  const LoopTask drive{model, options, fine};
  double bandwidth_Hz = options.bandwidth_Hz;
  ControlFilterChoice filters = aim.filters;
  if (aim.modulus || aim.crossover_Hz) {
    bandwidth_Hz = 0.0;
    double best_modulus = 0.0;
    for (const ControlFilterChoice& choice : filter_choices(aim, *measured.fit, model.data.sample_period_s)) {
      const HighestLoop found = highest_bandwidth({drive}, aim, choice);
      best_modulus = std::max(best_modulus, found.best_modulus);
      if (found.bandwidth_Hz <= bandwidth_Hz) continue;
      bandwidth_Hz = found.bandwidth_Hz;
      filters = choice;
    }
    if (bandwidth_Hz == 0.0)
      throw Failure(
          ExitCode::refused,
          fmt::format("no bandwidth reaches this on the measured response: the largest modulus margin is {:.3g}",
                      best_modulus));
  } else if (aim.seek_notch && !measured.fit->resonances.empty()) {
    filters.notch = Notch{measured.fit->resonances.front().f_Hz.value};
  }
  const AxisDesign plain = design_axis(model, options);
  AxisDesign tuned = design_at(drive, bandwidth_Hz);
  const AxisResponse after = with_controller(measured, designed_parameters(model, tuned, filters));
  return {std::move(tuned), filters, with_controller(measured, designed_parameters(model, plain)), after};
}

}  // namespace host
