// Free run of a model: from the first samples to the end of a record, from the command alone.
#pragma once

#include <optional>

#include "host/evidence/prepared_record.hpp"

namespace host {

/// Samples that a free run is given, as in the public EMPS benchmark (nonlinearbenchmark.org).
inline constexpr std::size_t kGivenSamples = 20;

/// RMS of the position error of a free run over all samples that were not given, mm or m. Nothing where the record has
/// no position, or hardly more samples than are given. The drift shows errors of friction and offset, which a free run
/// accumulates and a closed loop hides.
std::optional<double> free_run_rms(const sim::DriveDescription& model, const PreparedRecord& prepared);

}  // namespace host
