// Result of an improvement: as a sentence, as errors step by step, and as a report.
#pragma once

#include <string>

#include "host/diagnose/improvement.hpp"
#include "host/report/content.hpp"

namespace host {

/// Paths of the given and the improved model, as the user named them.
struct ImprovementFiles {
  std::string model, output;
};

/// "18.6 -> 0.78 x noise floor by adding cogging", the model's file, the remaining error, and the next command.
Verdict improvement_verdict(const Improvement& improvement, const ImprovementFiles& files);

/// Training and validation error of the given model and after each step, with the noise floor as reference.
BarChart ladder_chart(const Improvement& improvement);

/// The verdict, what was found, the errors step by step, and the residual before and after. Throws Failure(bad_input)
/// when it cannot write.
void write_improvement_report(const Improvement& improvement, const ImprovementFiles& files, const std::string& path);

}  // namespace host
