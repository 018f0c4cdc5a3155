#include "host/hil/identification_figures.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/evidence/measurement_gate.hpp"
#include "host/hil/commissioning.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/identify/identification.hpp"

namespace host {

namespace {

/// Section 3.1: scalings with enough excitation to overcome static friction.
constexpr double kScalings[] = {5.0, 7.5, 10.0, 12.5, 15.0};

TimePlot prediction_plot(const Record& steps, const sim::DriveDescription& machine, std::string_view axis) {
  TimePlot plot;
  plot.title = fmt::format("Axis {}: steps, speeds and their prediction (as Figs 6 and 8)", axis);
  plot.caption = "Both models get only the command, from rest to the end. Simple least squares ignores friction.";
  plot.t_s = steps.t_s;
  TracePanel speed{"speed", "rad/s", {{"measured", SeriesRole::measured, steps.w}}};
  TracePanel error{"prediction error", "rad/s", {}};
  for (const auto method : {IdentificationMethod::simple_ls, IdentificationMethod::unbiased_ls}) {
    const bool is_simple = method == IdentificationMethod::simple_ls;
    const SeriesRole role = is_simple ? SeriesRole::before : SeriesRole::model;
    const char* name = is_simple ? "simple least squares" : "unbiased least squares";
    const std::vector<double> predicted = free_run_speed(
        identify_drive(MeasurementGate(data_sheet_of(machine)).admit({steps}), data_sheet_of(machine), method).model,
        steps);
    std::vector<double> off(predicted.size());
    for (std::size_t k = 0; k < off.size(); ++k) off[k] = steps.w[k] - predicted[k];
    speed.traces.push_back({name, role, predicted});
    error.traces.push_back({name, role, std::move(off)});
  }
  plot.panels = {{"command", "V", {{"D/A converter", SeriesRole::other, steps.u_V}}}, speed, error};
  return plot;
}

/// A plot of an estimate over the scaling of the steps, by both methods.
struct EstimatePlot {
  const char* title;
  Axis quantity;
  Estimate (*value)(const RigidEstimate& estimate);
  bool of_simple;  ///< simple least squares also estimates it
};

const EstimatePlot kEstimates[] = {
    {"inertia", {"J", "kg m²"}, [](const RigidEstimate& e) { return e.inertia; }, true},
    {"viscous friction", {"B", "Nm s/rad"}, [](const RigidEstimate& e) { return e.viscous; }, true},
    {"Coulomb friction forward", {"Tc+", "Nm"}, [](const RigidEstimate& e) { return e.positive.value(); }, false},
    {"Coulomb friction backward", {"Tc-", "Nm"}, [](const RigidEstimate& e) { return e.negative.value(); }, false}};

}  // namespace

void add_identification_figures(const sim::DriveDescription& machine, std::string_view axis, std::uint64_t seed,
                                Report& report) {
  report.add(prediction_plot(commissioning_steps(machine, kScalings[4], seed), machine, axis));
  std::vector<ScatterPlot> plots;
  for (const EstimatePlot& shown : kEstimates) {
    ScatterPlot plot;
    plot.title = fmt::format("Axis {}: {} over the size of the steps (as Fig. 7)", axis, shown.title);
    plot.x = {"scaling of the steps, Ku", "1"};
    plot.y = shown.quantity;
    plot.series = {{"unbiased least squares", SeriesRole::model, SeriesStyle::points, {}, {}, {}, {}}};
    if (shown.of_simple)
      plot.series.push_back({"simple least squares", SeriesRole::before, SeriesStyle::points, {}, {}, {}, {}});
    plots.push_back(std::move(plot));
  }
  for (const double scaling : kScalings) {
    const Record steps = commissioning_steps(machine, scaling, seed);
    for (const auto method : {IdentificationMethod::unbiased_ls, IdentificationMethod::simple_ls}) {
      const std::size_t place = method == IdentificationMethod::simple_ls ? 1 : 0;
      const RigidEstimate found =
          identify_drive(MeasurementGate(data_sheet_of(machine)).admit({steps}), data_sheet_of(machine), method)
              .estimate;
      for (std::size_t i = 0; i < plots.size(); ++i) {
        if (place >= plots[i].series.size()) continue;
        const Estimate value = kEstimates[i].value(found);
        ScatterSeries& series = plots[i].series[place];
        series.x.push_back(scaling);
        series.y.push_back(value.value);
        series.lower.push_back(value.ci95[0]);
        series.upper.push_back(value.ci95[1]);
      }
    }
  }
  for (ScatterPlot& plot : plots) report.add(std::move(plot));
}

}  // namespace host
