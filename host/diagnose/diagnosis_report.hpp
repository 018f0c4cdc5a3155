// Reports of what is missing from a model, and of the ladder by which it was mended.
#pragma once

#include <string>

#include "host/diagnose/improvement.hpp"
#include "host/report/content.hpp"

namespace host {

/// Verdict in plain words, errors, where the model fails, candidates, and the residual before and after against the
/// coordinates in which effects show. `model_name` stands in the title. Throws Failure(bad_input) when it cannot write.
void write_diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name, const std::string& path);

/// The same for an improvement, with its ladder.
void write_improvement_report(const Improvement& improvement, const std::string& model_name, const std::string& path);

/// The ladder of errors: train and validation a rung, the floor as the reference.
BarChart ladder_chart(const Improvement& improvement);

}  // namespace host
