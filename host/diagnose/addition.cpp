#include "host/diagnose/addition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/evidence/log_faults.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/plausibility.hpp"

namespace host {

std::vector<std::string> added_kinds(const std::string& kind) {
  std::vector<std::string> kinds;
  for (std::size_t begin = 0; begin <= kind.size(); begin += kinds.back().size() + 1)
    kinds.push_back(kind.substr(begin, kind.find('+', begin) - begin));
  if (kinds.size() > 1 && std::ranges::find(kinds, "free_curve") != kinds.end())
    throw Failure(ExitCode::usage, "add a free_curve alone: it can take the shape of any other effect");
  return kinds;
}

Addition add_kind(const sim::DriveDescription& model, const std::string& kind, const std::string& over,
                  const Measurements& measured) {
  const std::vector<std::string> kinds = added_kinds(kind);
  const bool curve = kind == "free_curve";
  if (!curve && !over.empty()) throw Failure(ExitCode::usage, "--over applies only to free_curve");
  Addition addition = curve ? add_free_curve(model, over, measured) : add_effects(model, kinds, measured);
  const JudgedCandidate& judged = addition.judged;
  if (!(judged.before > 0.0) || !std::isfinite(judged.before) || !std::isfinite(judged.after))
    throw Failure(ExitCode::refused,
                  fmt::format("{}: not fitted: no part of these records can validate it (error over noise floor {:.3f} "
                              "-> {:.3f}); record longer, or give --validate. No model was written",
                              kind, judged.before, judged.after));
  return addition;
}

nlohmann::json to_json(const Addition& addition, const std::string& kind, const Measurements& measured,
                       const std::string& model_path) {
  nlohmann::json estimates = nlohmann::json::array();
  for (const ParameterEstimate& estimate : addition.estimates)
    estimates.push_back({{"name", estimate.name},
                         {"value", estimate.value},
                         {"deviation", estimate.deviation},
                         {"determined", estimate.determined},
                         {"correlated_with", estimate.correlated_with},
                         {"correlation", estimate.correlation}});
  const JudgedCandidate& judged = addition.judged;
  return {{"format", "axis-addition/1"},
          {"kind", kind},
          {"before", judged.before},
          {"after", judged.after},
          {"train_after", judged.train_after},
          {"confidence", judged.confidence},
          {"held_back", addition.held_back},
          {"error", {{"given", to_json(addition.given)}, {"after", to_json(addition.error)}}},
          {"kept", addition.kept_given ? "given" : "improved"},
          {"parameters", std::move(estimates)},
          {"log", log_faults_json(measured.log())},
          {"warnings", messages_of(doubts_of(judged.model))},
          {"model", model_path}};
}

}  // namespace host
