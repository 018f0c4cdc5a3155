// Makes the verdict from the candidates: the missing effect, the effects that the data cannot tell apart, and the next
// measurement.
#pragma once

#include "host/diagnose/diagnosis.hpp"
#include "host/search/explained_share.hpp"

namespace host {

/// Whether a refit changed a parameter of an effect by more than 5 %, or its form.
bool has_moved(const sim::EffectEntry& before, const sim::EffectEntry& after);

/// Kinds of the base with a parameter that a refit changed by more than 5 %.
std::vector<std::string> moved_parameters(const sim::DriveDescription& given, const sim::DriveDescription& base);

/// Fills the verdict of a diagnosis whose candidates have been compared; `given` is the model before its refit.
DiagnosisVerdict reach_verdict(const sim::DriveDescription& given, const Diagnosis& diagnosis);

/// The verdict if the axis hardly moved.
DiagnosisVerdict insufficient_data(const sim::DriveDescription& model, const PreparedSets& sets);

}  // namespace host
