// The residual of an effect that a model lacks, in a standard run of a simulated drive.
#pragma once

#include <string_view>

#include "host/report/content.hpp"
#include "sim/effect.hpp"

namespace host::workbench {

struct EffectPicture {
  ScatterPlot plot;  ///< the residual over the effect's coordinate, and the effect's contribution as a line
  /// RMS residual of the standard run with the effect over that of the same run without it; 1 if it leaves no trace.
  double stands_out = 1.0;
};

/// The paper's x axis, in jogs of both directions from 1.5 to 90 rad/s with rests between them, simulated with the
/// effect and without; a scale on the table shows effects of the table. Values are the catalogue's examples; for
/// effects that act beyond a limit, one that the run reaches. For inertia and friction, the model is 20 % off.
EffectPicture picture_of(const sim::EffectInfo& info);

}  // namespace host::workbench
