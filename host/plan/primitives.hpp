// The pieces that a plan chooses from: the kinds of excitation that a board has, with numbers that suit drive and box.
#pragma once

#include <vector>

#include "host/plan/run_plan.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Ladders of jogs, micro-reversals, dwells between jogs that end at several phases of a turn, slow sines beneath which
/// the axis rides one way, accelerations over one stroke, steps at two voltages, multisines and coast-downs, each with
/// a few sizes between what moves the axis at all and the box. Whether a piece stays in the box a simulation must tell.
std::vector<RunPiece> candidate_pieces(const sim::DriveDescription& model, const ExcitationLimits& box);

}  // namespace host
