// An excitation that did not end by itself, as an error.
#pragma once

#include <string>

#include "host/device/excitation.hpp"

namespace host {

/// Throws Failure(device_fault) with cause and remedy where the axis has a fault, Failure(refused) where it was
/// stopped, left its box or did not move, Failure(protocol) where rows were lost: with what to do. `kept`: where the
/// record is, in words; may be empty.
void require_completed(BoardClient& board, std::uint8_t axis, const ExcitationOutcome& outcome,
                       const std::string& kept);

}  // namespace host
