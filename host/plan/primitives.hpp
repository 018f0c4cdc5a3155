// The pieces for plans: the board's kinds of excitation, with numbers that suit drive and box.
#pragma once

#include <vector>

#include "host/plan/run_plan.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Ladders of jogs, micro-reversals, dwells between jogs that end at several phases of a turn, slow sines on a jog in
/// one direction, accelerations over one stroke, steps at two voltages, multisines and coast-downs. Each comes in a few
/// sizes between the smallest that moves the axis and the box. A simulation must show whether a piece stays in the box.
std::vector<RunPiece> candidate_pieces(const sim::DriveDescription& model, const ExcitationLimits& box);

}  // namespace host
