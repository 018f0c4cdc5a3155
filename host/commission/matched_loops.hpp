// One closed loop for the commissioned axes of a machine (Erkorkmaz & Altintas 2001, p. 1487).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/commission/session.hpp"

namespace host {

/// An axis whose commissioning is complete; `folder` outlives it.
struct CommissionedAxis {
  CommissionOptions options;
  CommissionFolder* folder;
};

/// Designs one loop for all axes from their improved models and measured responses, as fast as the slowest axis allows
/// at the requested margin, downloads it, and makes each axis's jogs again. Makes matched-params.toml and matched.csv
/// in each folder. Returns the design (axis-machine-design/1) with "following_error_um" of each axis: "own" as
/// commissioned, "matched". A failure restores the board's parameters; the axes are disabled at the end.
nlohmann::json match_loops(BoardClient& board, const std::vector<CommissionedAxis>& axes, const CommissionTalk& talk);

}  // namespace host
