// The robust method: response, noise and nonlinearity from realisations and periods of multisines.
#pragma once

#include <vector>

#include "host/response/frequency_response.hpp"
#include "host/response/periodic_run.hpp"

namespace host {

/// For runs with the same excited lines: best linear approximation relative to the excitation, G = mean(Y/R) /
/// mean(U/R) (Pintelon & Schoukens, 2nd ed., eqs. (4-49) ff.). With a single realisation the covariance contains noise
/// only, not nonlinearity. `runs` is not empty and all have the same period and lines.
std::vector<ResponseLine> robust_response(const std::vector<PeriodicRun>& runs);

}  // namespace host
