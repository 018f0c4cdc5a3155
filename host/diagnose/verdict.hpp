// From judged candidates to an answer: what is missing, what the data cannot tell, and what to measure next.
#pragma once

#include "host/diagnose/diagnosis.hpp"

namespace host {

/// A combined error up to which nothing is left to explain: a perfect model gives about 1.
inline constexpr double kExplained = 1.25;

/// Whether a re-fit moved a parameter of an effect by more than a twentieth.
bool has_moved(const sim::EffectEntry& before, const sim::EffectEntry& after);

/// Kinds of the base of which a re-fit moved a parameter by more than a twentieth.
std::vector<std::string> moved_parameters(const sim::DriveDescription& given, const sim::DriveDescription& base);

/// Fills the verdict of a diagnosis whose candidates are judged; `given` is the model before its re-fit.
DiagnosisVerdict reach_verdict(const sim::DriveDescription& given, const Diagnosis& diagnosis);

/// The verdict where the axis hardly moved.
DiagnosisVerdict insufficient_data(const sim::DriveDescription& model, const PreparedSets& sets);

}  // namespace host
