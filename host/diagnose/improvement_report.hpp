// What became of a model that was improved: in a sentence, as errors step by step, as a page.
#pragma once

#include <string>

#include "host/diagnose/improvement.hpp"
#include "host/report/content.hpp"

namespace host {

/// The model that was improved and the one that came of it, as the user named them.
struct ImprovementFiles {
  std::string model, output;
};

/// "18.6 -> 0.78 x noise floor by adding cogging", where the model is, what is left, and the command that comes next.
Verdict improvement_verdict(const Improvement& improvement, const ImprovementFiles& files);

/// Errors from the model as it was given: train and validation a step, the noise floor as the reference.
BarChart ladder_chart(const Improvement& improvement);

/// The verdict, what was found, the errors step by step, and the residual before and after. Throws Failure(bad_input)
/// when it cannot write.
void write_improvement_report(const Improvement& improvement, const ImprovementFiles& files, const std::string& path);

}  // namespace host
