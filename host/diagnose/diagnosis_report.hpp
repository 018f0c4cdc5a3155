// Report on the effect that a model lacks.
#pragma once

#include <string>

#include "host/diagnose/diagnosis.hpp"
#include "host/report/report.hpp"

namespace host {

/// Verdict in plain words, errors, where the model fails, candidates, and the residual before and after against the
/// coordinates in which effects show. `model_name` appears in the title.
Report diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name);

/// The same, to a file. Throws Failure(bad_input) when it cannot write.
void write_diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name, const std::string& path);

}  // namespace host
