// Envelopes as JSON for the page's scope.
#pragma once

#include <cstdint>
#include <string>

#include "host/record/envelope.hpp"

namespace host::workbench {

/// { "epoch", "first", "rows", "taken": [...], "low": [[...]], "high": [[...]] }; no "high" where buckets have one row.
/// A number that is not finite is null.
std::string envelope_text(const Envelope& envelope, std::uint64_t epoch);

}  // namespace host::workbench
