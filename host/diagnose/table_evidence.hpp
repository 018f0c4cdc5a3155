// What a sensor on the table decides of a diagnosis: backlash, wind-up and pitch errors are measured there, not
// inferred.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/scale/table_study.hpp"

namespace host {

/// Kinds of connections between motor and table that the table shows not to be there. Both or none: they leave one
/// trace in the motion, and what tells them apart is said by settle_by_table().
std::vector<std::string> absent_by_table(const TableStudy& study);

/// Names what the table shows beside what the motion does, and takes back what it contradicts. Needs the found effects
/// of the motion.
void settle_by_table(const TableStudy& study, Diagnosis& diagnosis);

/// Where only the motor's encoder was recorded and backlash or compliance is named: what a scale or a dial gauge would
/// decide; empty elsewhere.
std::string advice_on_a_scale(const DiagnosisVerdict& verdict);

}  // namespace host
