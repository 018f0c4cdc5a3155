// What an effect leaves in the residual of a model that lacks it, on a standard run of a simulated drive.
#pragma once

#include <string_view>

#include "host/report/content.hpp"
#include "sim/effect.hpp"

namespace host::workbench {

struct EffectPicture {
  ScatterPlot plot;  ///< the residual over the effect's coordinate, and the effect's own part as a line
  /// RMS residual of the standard run with the effect over that of the same run without it; 1 where it leaves no trace.
  double stands_out = 1.0;
};

/// The paper's x axis, in jogs of both directions from 1.5 to 90 rad/s with rests between them, simulated with the
/// effect and without; effects of the table are read by a scale on it. Values are the catalogue's examples, of effects
/// that act beyond some limit one that the run reaches; of inertia and friction the model is 20 % off.
EffectPicture picture_of(const sim::EffectInfo& info);

}  // namespace host::workbench
