#include "host/demo/model_plot.hpp"

#include <cmath>

namespace host {

TimePlot model_plot(const std::string& quantity, const std::string& unit, const std::vector<double>& t_s,
                    const std::vector<double>& measured, const std::vector<double>& modelled) {
  std::vector<double> difference(measured.size());
  for (std::size_t k = 0; k < measured.size(); ++k) difference[k] = measured[k] - modelled[k];
  TimePlot plot;
  plot.t_s = t_s;
  plot.panels = {
      {quantity, unit, {{"measured", SeriesRole::measured, measured}, {"model", SeriesRole::predicted, modelled}}},
      {"difference", unit, {{"measured - model", SeriesRole::residual, std::move(difference)}}}};
  return plot;
}

double rms_difference(const std::vector<double>& measured, const std::vector<double>& modelled) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    if (std::isnan(modelled[k])) continue;
    sum += (measured[k] - modelled[k]) * (measured[k] - modelled[k]);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

}  // namespace host
