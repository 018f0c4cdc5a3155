#include "host/fit/prediction_fit.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/fit/base_fit.hpp"
#include "host/fit/model_fit.hpp"
#include "host/identify/inverse_model.hpp"

namespace host {

namespace {

Estimate estimate_of(const sim::EffectEntry& entry, const std::string& id) {
  const auto interval = entry.ci95.find(id);
  const double value = entry.at(id);
  return {value, interval != entry.ci95.end() ? interval->second : std::array{value, value}};
}

}  // namespace

PredictionFit fit_for_prediction(Identification& found, const Measurements& measured, double window_s) {
  std::vector<const Record*> records;
  for (const Record& record : measured.training()) {
    records.push_back(&record);
    if (record.sample_period_s * static_cast<double>(record.size()) < window_s)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: shorter than a prediction of {:g} s; lower --window", record.path, window_s));
  }
  RecordSet set = compare_on(records, found.model, window_s);
  PredictionFit fit{window_s, 0.0, 0.0, found.relative_error};
  const sim::Drive given(found.model);
  sim::DriveDescription fitted = fit_base(found.model, set);
  renew_floors(set, fitted);
  fit.before = error_of(given, set).combined;
  fit.after = error_of(sim::Drive(fitted), set).combined;
  estimate_intervals(fitted, set);
  found.model = fitted;
  found.estimate.inertia = estimate_of(*fitted.find("inertia"), "J");
  found.estimate.viscous = estimate_of(*fitted.find("viscous"), "B");
  if (const sim::EffectEntry* coulomb = fitted.find("coulomb"); coulomb != nullptr && coulomb->has("positive")) {
    found.estimate.positive = estimate_of(*coulomb, "positive");
    found.estimate.negative = estimate_of(*coulomb, "negative");
  } else if (coulomb != nullptr) {
    const Estimate level = estimate_of(*coulomb, "level");
    found.estimate.positive = level;
    found.estimate.negative = Estimate{-level.value, {-level.ci95[1], -level.ci95[0]}};
  }
  found.relative_error = relative_error(fitted, measured.training());
  return fit;
}

nlohmann::json prediction_json(const PredictionFit& fit) {
  return {{"window_s", fit.window_s},
          {"before", fit.before},
          {"after", fit.after},
          {"relative_error_before", fit.relative_error_before}};
}

}  // namespace host
