#include "host/diagnose/diagnosis_json.hpp"

#include <algorithm>
#include <utility>

#include "host/diagnose/effort_diagnosis.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/evidence/log_faults.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/scale/table_study.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

nlohmann::json channel_json(const ErrorOnSets& error, const std::string& name, double ChannelFigures::*what) {
  nlohmann::json document;
  for (const auto& [set, figures] : {std::pair("train", &error.train), std::pair("validate", &error.validate)}) {
    const auto channel = std::ranges::find(figures->channels, name, &ChannelFigures::name);
    document[set] = channel == figures->channels.end() ? nlohmann::json(nullptr) : nlohmann::json((*channel).*what);
  }
  return document;
}

nlohmann::json channels_json(const Diagnosis& diagnosis) {
  nlohmann::json document = nlohmann::json::object();
  for (const ChannelFigures& channel : diagnosis.best_error.validate.channels)
    document[channel.name] = {{"before", channel_json(diagnosis.base_error, channel.name, &ChannelFigures::rms)},
                              {"after", channel_json(diagnosis.best_error, channel.name, &ChannelFigures::rms)},
                              {"floor", channel_json(diagnosis.best_error, channel.name, &ChannelFigures::floor)}};
  if (const std::optional<EffortError>& effort = diagnosis.effort)
    document[effort->name] = {{"before", {{"train", effort->before_train}, {"validate", effort->before_validate}}},
                              {"after", {{"train", effort->after_train}, {"validate", effort->after_validate}}},
                              {"floor", {{"train", effort->floor_train}, {"validate", effort->floor_validate}}}};
  return document;
}

std::string measure_name(const Diagnosis& diagnosis) {
  return diagnosis.measure == Measure::effort ? "effort" : "motion";
}

nlohmann::json combined_json(double train, double validate) { return {{"train", train}, {"validate", validate}}; }

/// Combined errors in the measure that decided. If that is the motion over the usual windows, they are those of
/// ErrorOnSets.
nlohmann::json combined_json(const Diagnosis& diagnosis) {
  const auto of = [](const ErrorOnSets& error) { return combined_json(error.train.combined, error.validate.combined); };
  if (diagnosis.judged_as_compared())
    return {{"given", of(diagnosis.given_error)},
            {"before", of(diagnosis.base_error)},
            {"after", of(diagnosis.best_error)}};
  return {{"given", combined_json(diagnosis.given_train, diagnosis.given_validate)},
          {"before", combined_json(diagnosis.before_train, diagnosis.before_validate)},
          {"after", combined_json(diagnosis.after_train, diagnosis.after_validate)}};
}

nlohmann::json parameters_json(const sim::EffectEntry& entry, sim::DriveKind kind) {
  nlohmann::json document = nlohmann::json::object();
  const sim::EffectInfo& info = *sim::find_effect(entry.kind);
  const auto key_of = [&](std::string_view id) { return std::string(info.parameter(id)->key(kind)); };
  const bool in_a_list = std::ranges::any_of(
      entry.parameters, [](const auto& parameter) { return sim::number_of(parameter.first).has_value(); });
  for (const auto& [id, value] : entry.parameters) {
    const bool listed = in_a_list && (info.curve || id != "period");
    if (!listed) document[key_of(id)] = value;
  }
  if (in_a_list && info.periodic)
    for (const sim::HarmonicTerm& term : sim::harmonics_of(entry))
      document["harmonics"].push_back(
          {{"order", term.order}, {key_of("cosine"), term.cosine}, {key_of("sine"), term.sine}});
  if (info.curve) {
    const sim::Curve curve(entry);
    document["over"] = entry.over;
    document[key_of("knot")] = curve.knots();
    document[key_of("value")] = curve.values();
  }
  return document;
}

nlohmann::json candidate_json(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  nlohmann::json parameters = nlohmann::json::object();
  for (const std::string& kind : candidate.kinds)
    parameters[kind] = parameters_json(*candidate.model.find(kind), candidate.model.data.kind);
  const sim::EffectInfo& info = *sim::find_effect(candidate.kinds.back());
  return {{"kinds", candidate.kinds},
          {"before", diagnosis.printed_base().validate},
          {"after", Diagnosis::printed(candidate).validate},
          {"train_after", Diagnosis::printed(candidate).train},
          {"parameters", candidate.kinds.size() == 1 ? parameters.begin().value() : parameters},
          {"confidence", candidate.confidence},
          {"luck", candidate.luck},
          {"probability", candidate.probability},
          {"on_bound", candidate.on_bound},
          {"confused_with", std::vector<std::string>(info.confused_with.begin(), info.confused_with.end())},
          {"separate_by", std::string(info.separate_by)}};
}

nlohmann::json correlation_json(const Correlation& correlation) {
  return {{"lag_s", correlation.lag_s}, {"value", correlation.value}, {"bound", correlation.bound}};
}

nlohmann::json residual_json(const ResidualTests& tests) {
  nlohmann::json dependences = nlohmann::json::array();
  for (const ResidualDependence& dependence : tests.dependences)
    dependences.push_back({{"coordinate", dependence.coordinate},
                           {"share", dependence.share},
                           {"in_detail", dependence.in_detail},
                           {"where", dependence.where}});
  return {{"rms", tests.rms},
          {"dependences", std::move(dependences)},
          {"near_reversals", tests.near_reversals},
          {"autocorrelation", correlation_json(tests.with_itself)},
          {"correlation_with_command", correlation_json(tests.with_command)}};
}

nlohmann::json verdict_json(const DiagnosisVerdict& verdict) {
  nlohmann::json document = {{"status", std::string(status_name(verdict.status))},
                             {"effects", verdict.effects},
                             {"parameters", verdict.parameters},
                             {"alternatives", verdict.alternatives},
                             {"data_sheet", verdict.data_sheet},
                             {"probability_nothing", verdict.probability_nothing},
                             {"probability_other", verdict.probability_other},
                             {"found", nlohmann::json::array()},
                             {"next_experiment", verdict.next_experiment},
                             {"explanation", verdict.explanation}};
  for (const CertainEffects& found : verdict.found)
    document["found"].push_back({{"kinds", found.kinds},
                                 {"probability", found.probability},
                                 {"share_before", found.share_before},
                                 {"share_after", found.share_after}});
  if (const std::optional<Remains>& remains = verdict.remains)
    document["remains"] = {{"share", remains->share},
                           {"over_floor", remains->over_floor},
                           {"coordinate", remains->coordinate},
                           {"where", remains->where}};
  if (!verdict.coordinate.empty()) {
    document["coordinate"] = verdict.coordinate;
    document["where"] = verdict.where;
  }
  return document;
}

nlohmann::json timing_json(const PreparedSets& sets) {
  std::vector<const Record*> records;
  for (const RecordSet* set : {&sets.training, &sets.validation})
    for (const PreparedRecord* prepared : prepared_records(*set))
      if (std::ranges::find(records, prepared->record) == records.end()) records.push_back(prepared->record);
  return effort_timing_json(records);
}

}  // namespace

nlohmann::json to_json(const Diagnosis& diagnosis) {
  nlohmann::json candidates = nlohmann::json::array();
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    candidates.push_back(candidate_json(candidate, diagnosis));
  nlohmann::json document = {
      {"format", "axis-diagnosis/1"},
      {"effort_timing", timing_json(diagnosis)},
      {"error",
       {{"window_s", diagnosis.window_s},
        {"measure", measure_name(diagnosis)},
        {"held_back", diagnosis.held_back},
        {"kept_back", {{"block_s", diagnosis.blocks.block_s}, {"one_of", diagnosis.blocks.every}}},
        {"moving_s", {{"train", diagnosis.moving_train_s}, {"validate", diagnosis.moving_validate_s}}},
        {"independent_windows",
         {{"train", independent_windows(diagnosis.moving_train_s)},
          {"validate", independent_windows(diagnosis.moving_validate_s)}}},
        {"channels", channels_json(diagnosis)},
        {"given", to_json(diagnosis.given_error)},
        {"before", to_json(diagnosis.base_error)},
        {"after", to_json(diagnosis.best_error)},
        {"combined", combined_json(diagnosis)}}},
      {"log", log_faults_json(diagnosis.log)},
      {"where", error_regions_json(diagnosis.where)},
      {"candidates", candidates},
      {"search", {{"not_searched", diagnosis.not_searched}}},
      {"verdict", verdict_json(diagnosis.verdict)}};
  document["found"] = document["verdict"]["found"];
  if (!diagnosis.residual.dependences.empty()) document["residual"] = residual_json(diagnosis.residual);
  if (diagnosis.table && !diagnosis.table->empty()) document["table"] = table_json(*diagnosis.table);
  if (diagnosis.screen) document["error"]["effort_screen"] = effort_screen_json(*diagnosis.screen);
  if (diagnosis.screen && diagnosis.screen->repeatable)
    document["error"]["repeatable"] = diagnosis.screen->repeatable->share;
  return document;
}

nlohmann::json to_json(const Improvement& improvement, const std::string& model_path) {
  nlohmann::json ladder = nlohmann::json::array(), channels = nlohmann::json::array();
  for (const Rung& rung : improvement.ladder) {
    ladder.push_back(
        {{"added", rung.added}, {"train", rung.train}, {"validate", rung.validate}, {"error", to_json(rung.error)}});
    nlohmann::json row = {{"added", rung.added}, {"channels", nlohmann::json::object()}};
    for (const ChannelFigures& channel : rung.error.validate.channels) {
      row["channels"][channel.name] = channel_json(rung.error, channel.name, &ChannelFigures::rms);
      row["channels"][channel.name]["floor"] = channel_json(rung.error, channel.name, &ChannelFigures::floor);
    }
    channels.push_back(row);
  }
  const Diagnosis& first = improvement.first;
  return {{"format", "axis-improvement/1"},
          {"effort_timing", timing_json(first)},
          {"measure", measure_name(first)},
          {"given", combined_json(first)["given"]},
          {"error", {{"given", to_json(first.given_error)}, {"after", to_json(improvement.error)}}},
          {"kept", improvement.kept_given ? "given" : "improved"},
          {"ladder", ladder},
          {"channels", channels},
          {"stopped_because", improvement.stopped_because},
          {"log", log_faults_json(improvement.first.log)},
          {"verdict", verdict_json(improvement.verdict)},
          {"model", model_path}};
}

}  // namespace host
