#include "host/diagnose/adjustment.hpp"

#include "host/evidence/log_faults.hpp"
#include "host/identify/plausibility.hpp"

namespace host {

Adjustment adjust(const sim::DriveDescription& model, const sim::DriveDescription& adjusted,
                  const Measurements& measured) {
  const FigureRows rows = figure_rows(model, measured);
  return {adjusted, rows.error_of(model), rows.error_of(adjusted)};
}

nlohmann::json to_json(const Adjustment& adjustment, const std::vector<std::string>& values,
                       const Measurements& measured, const std::string& model_path) {
  return {{"format", "axis-adjustment/1"},
          {"values", values},
          {"error", {{"given", to_json(adjustment.given)}, {"after", to_json(adjustment.after)}}},
          {"log", log_faults_json(measured.log())},
          {"warnings", messages_of(doubts_of(adjustment.model))},
          {"model", model_path}};
}

}  // namespace host
