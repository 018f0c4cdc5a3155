// The board's log of its last faults, in words and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "firmware/app/parameters/parameter_values.hpp"
#include "host/device/board_client.hpp"

namespace host {

/// One line per entry, oldest first; empty if nothing was logged. `values`: the board's, if this program knows its
/// table; without them positions are in counts.
std::string fault_log_text(const FaultLog& log, const firmware::ParameterValues* values);
nlohmann::json fault_log_json(const FaultLog& log, const firmware::ParameterValues* values);

}  // namespace host
