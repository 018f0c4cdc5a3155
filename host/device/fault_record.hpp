// The samples that an axis kept from before its fault, as a record.
#pragma once

#include <cstdint>
#include <optional>

#include "host/device/board_client.hpp"
#include "host/record/read_record.hpp"

namespace host {

/// Empty if the axis kept no samples, or too few for a record.
std::optional<Record> read_fault_record(BoardClient& board, std::uint8_t axis, sim::DriveKind kind);

}  // namespace host
