// Starting values of the fit of a candidate effect: models with the effect added at values that suit drive and records.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"
#include "sim/effect.hpp"

namespace host {

/// Scales of the drive and the records; the catalogue gives its starting values relative to them.
struct RecordScales {
  double travel = 0.0;      ///< mm or m that the records cover
  double middle = 0.0;      ///< middle of that travel, mm or m
  double top_speed = 0.0;   ///< rad/s or m/s
  double duration_s = 0.0;  ///< of the longest record
  double first_stamp_s = 0.0;
  double top_command_V = 0.0;
};

RecordScales scales_of(const RecordSet& set);

/// Whether the effect can be added to this model and observed in these records: it is not in the model, is not part of
/// an effect in the model, and is visible in a recorded channel.
bool is_applicable(const sim::EffectInfo& info, const sim::DriveDescription& model, const RecordSet& set);

/// Whether two effects describe the same part of a drive, so that one drive cannot have both.
bool exclude_each_other(const sim::EffectInfo& a, const sim::EffectInfo& b);

/// The model with the effect added: one start for every combination of the catalogue's starting values, or, for a
/// periodic effect, one for every significant period of the residual.
std::vector<sim::DriveDescription> starting_models(const sim::EffectInfo& info, const sim::DriveDescription& model,
                                                   const RecordSet& set);

}  // namespace host
