// Residual of a model that lacks an effect, in a standard run of a simulated drive.
#pragma once

#include <string_view>

#include "host/report/content.hpp"
#include "sim/effect.hpp"

namespace host::workbench {

struct EffectPicture {
  ScatterPlot plot;  ///< the residual over the effect's coordinate, and the effect's contribution as a line
  /// RMS residual of the standard run with the effect relative to the same run without it; 1 if the effect is not
  /// visible.
  double stands_out = 1.0;
  double explained = 0.0;  ///< share of the squares in the plot that the effect explains; 0 if it is no effect_plot()
};

/// The paper's x axis, in jogs of both directions from 1.5 to 90 rad/s with rests of 0.1 to 0.8 s between them,
/// simulated with the effect and without; a scale on the table shows effects of the table. Values are the catalogue's
/// examples; limits are chosen so that the run exceeds them. For inertia and friction, the model has an error of 20 %.
EffectPicture picture_of(const sim::EffectInfo& info);

}  // namespace host::workbench
