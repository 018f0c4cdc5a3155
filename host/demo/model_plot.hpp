// Measured and modelled signal and their difference, as in the paper's Fig. 8.
#pragma once

#include <string>
#include <vector>

#include "host/report/content.hpp"

namespace host {

/// Two panels with one time axis: both signals, then measured minus modelled. NaN in `modelled` leaves gaps.
TimePlot model_plot(const std::string& quantity, const std::string& unit, const std::vector<double>& t_s,
                    const std::vector<double>& measured, const std::vector<double>& modelled);

/// Root mean square of measured minus modelled, over the values with a model.
double rms_difference(const std::vector<double>& measured, const std::vector<double>& modelled);

}  // namespace host
