// Decisions by a sensor on the table in a diagnosis. The sensor measures backlash, wind-up and pitch errors, which are
// otherwise inferred from the motion.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/scale/table_study.hpp"

namespace host {

/// Kinds of connections between motor and table that the table's sensor excludes: both or none, because both have the
/// same effect on the motion. settle_by_table() tells them apart.
std::vector<std::string> absent_by_table(const TableStudy& study);

/// Names the effects that the table shows in addition to those of the motion, and withdraws those that it contradicts.
/// Needs the effects found in the motion.
void settle_by_table(const TableStudy& study, Diagnosis& diagnosis);

/// If backlash or compliance is named and only the motor's encoder was recorded: what a scale or a dial gauge would
/// decide. Empty otherwise.
std::string advice_on_a_scale(const DiagnosisVerdict& verdict);

}  // namespace host
