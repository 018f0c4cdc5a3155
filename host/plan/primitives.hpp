// The pieces for plans: the board's kinds of excitation with values that suit drive and box.
#pragma once

#include <vector>

#include "host/plan/run_plan.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Ladders of jogs, micro-reversals, dwells between jogs that end at several angles of a turn, slow sines on a jog in
/// one direction, accelerations over one stroke, steps at two voltages, multisines and coast-downs. Each kind has a few
/// sizes, from the smallest that moves the axis to the largest that the box allows. A simulation must show whether a
/// piece stays in the box.
std::vector<RunPiece> candidate_pieces(const sim::DriveDescription& model, const ExcitationLimits& box);

}  // namespace host
