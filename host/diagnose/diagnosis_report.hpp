// Report on the effect that a model lacks.
#pragma once

#include <string>

#include "host/diagnose/diagnosis.hpp"
#include "host/report/report.hpp"

namespace host {

/// The verdict in words, the errors, the regions with the largest error, the candidates, and the residual before and
/// after over the coordinates in which effects show. `model_name` appears in the title.
Report diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name);

/// The same, to a file. Throws Failure(bad_input) when it cannot write.
void write_diagnosis_report(const Diagnosis& diagnosis, const std::string& model_name, const std::string& path);

}  // namespace host
