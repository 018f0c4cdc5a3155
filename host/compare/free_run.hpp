// Free run of a model: a simulation from the first samples to the end of a record, by the command alone.
#pragma once

#include <optional>

#include "host/evidence/prepared_record.hpp"

namespace host {

/// Number of measured samples with which a free run starts, as in the public EMPS benchmark (nonlinearbenchmark.org).
inline constexpr std::size_t kGivenSamples = 20;

/// RMS of the position error of a free run over all samples after the given ones, mm or m. Empty if the record has no
/// position or hardly more samples than are given. The drift shows errors of friction and offset: they accumulate in a
/// free run, while a closed loop would compensate them.
std::optional<double> free_run_rms(const sim::DriveDescription& model, const PreparedRecord& prepared);

}  // namespace host
