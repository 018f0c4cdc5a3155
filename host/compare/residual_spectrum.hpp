// Spectrum of a model's torque or force residual.
#pragma once

#include <span>

#include "host/compare/residual_figures.hpp"

namespace host {

/// One-sided amplitude spectral density, Nm/sqrt(Hz) or N/sqrt(Hz), over Hz. Welch's method with Hann windows of 1.28 s
/// that overlap by half. The residual is zero at rest, and windows with rest for more than half of their length are
/// left out. Empty if no window remains.
ScatterSeries spectrum_of_residual(const ResidualEffort& samples);

/// The spectra of all views that have one, in one plot.
void add_residual_spectrum(Report& report, std::span<const ResidualView> views, sim::DriveKind kind);

}  // namespace host
