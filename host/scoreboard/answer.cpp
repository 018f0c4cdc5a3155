#include "host/scoreboard/answer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "host/diagnose/improvement.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/fit/prepared_sets.hpp"
#include "host/model/model_file.hpp"
#include "host/scoreboard/simulated_null.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"

namespace host {

namespace {

std::vector<const Record*> pointers(const std::vector<Record>& records) {
  std::vector<const Record*> result;
  for (const Record& record : records) result.push_back(&record);
  return result;
}

std::vector<Record> read_pieces(const std::vector<Piece>& pieces, const sim::DataSheet& data) {
  std::vector<Record> records;
  for (const Piece& piece : pieces) records.push_back(read_piece(piece, data));
  return records;
}

}  // namespace

std::string_view outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::right:
      return "right";
    case Outcome::group:
      return "group";
    case Outcome::partly:
      return "partly";
    case Outcome::wrong:
      return "wrong";
    case Outcome::missed:
      return "missed";
  }
  return "";
}

Outcome outcome_of(const Truth& truth, const DiagnosisVerdict& verdict) {
  const auto claims = [&](const std::string& kind) {
    return std::ranges::find(verdict.effects, kind) != verdict.effects.end();
  };
  const auto is_offered = [&](const std::string& kind) {
    return claims(kind) || std::ranges::any_of(verdict.alternatives, [&](const std::vector<std::string>& group) {
             return std::ranges::find(group, kind) != group.end();
           });
  };
  const auto is_true = [&](const std::string& kind) {
    return std::ranges::find(truth.effects, kind) != truth.effects.end();
  };
  const bool all_clear = verdict.status == Status::adequate || verdict.status == Status::parameters;
  if (truth.alien) return verdict.effects.empty() && !all_clear ? Outcome::right : Outcome::wrong;
  if (verdict.effects.empty()) return truth.effects.empty() ? Outcome::right : Outcome::missed;
  // A group of which no effect is named counts as one more effect.
  const auto unnamed =
      static_cast<std::size_t>(std::ranges::count_if(verdict.alternatives, [&](const std::vector<std::string>& group) {
        return std::ranges::none_of(group, claims);
      }));
  if (std::ranges::is_permutation(truth.effects, verdict.effects) && verdict.status == Status::missing && unnamed == 0)
    return Outcome::right;
  if (!truth.effects.empty() && std::ranges::all_of(truth.effects, is_offered) &&
      (verdict.status == Status::ambiguous || truth.effects.size() == verdict.effects.size() + unnamed))
    return Outcome::group;
  return std::ranges::all_of(verdict.effects, is_true) ? Outcome::partly : Outcome::wrong;
}

double Answer::explained() const {
  const double there_is = before * before - 1.0;
  return there_is > 0.0 ? (before * before - after * after) / there_is : 0.0;
}

Answer answer_of(const std::string& name, const std::string& group, const Truth& truth, const Diagnosis& diagnosis,
                 double seconds) {
  Answer answer{name,
                group,
                truth,
                diagnosis.verdict,
                diagnosis.before_validate,
                diagnosis.after_validate,
                seconds,
                outcome_of(truth, diagnosis.verdict),
                {}};
  if (diagnosis.verdict.probability_nothing + diagnosis.verdict.probability_other <= 0.0 &&
      diagnosis.candidates.empty())
    return answer;  // too short for a search: no forecasts
  bool among = false;
  for (const JudgedCandidate& candidate : diagnosis.candidates) {
    const bool is_it = !truth.alien && std::ranges::is_permutation(candidate.kinds, truth.effects);
    among = among || is_it;
    answer.forecasts.emplace_back(candidate.probability, is_it);
  }
  const bool nothing = truth.effects.empty() && !truth.alien;
  answer.forecasts.emplace_back(diagnosis.verdict.probability_nothing, nothing);
  answer.forecasts.emplace_back(diagnosis.verdict.probability_other, !nothing && !among);
  return answer;
}

namespace {

/// Diagnoses the records if the gate accepts them; otherwise the answer is empty.
Answer ask(const std::string& name, const std::string& group, const Truth& truth, const sim::DriveDescription& model,
           std::vector<Record> train, std::vector<Record> validate, const ShareDone& progress,
           const std::vector<std::string>& absent = {}) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  try {
    const Measurements measured = MeasurementGate(model).admit(std::move(train), std::move(validate));
    const Diagnosis diagnosis = diagnose(model, measured, progress, nullptr, absent);
    return answer_of(name, group, truth, diagnosis, seconds());
  } catch (const Failure& refused) {
    Answer answer{name, group, truth, {}, 0.0, 0.0, seconds(), Outcome::missed, {}};
    answer.verdict.status = Status::insufficient_data;
    answer.verdict.explanation = refused.what();
    answer.outcome = outcome_of(truth, answer.verdict);
    return answer;
  }
}

}  // namespace

Answer run_trial(const Trial& trial, const ShareDone& progress) {
  const sim::DriveDescription model = read_model((trial.folder / "model.toml").string());
  return ask(trial.name, trial.group, read_truth(trial.folder), model, read_pieces(trial.train, model.data),
             read_pieces(trial.validate, model.data), progress);
}

LeftOut leave_out(const Trial& trial, const ShareDone& progress) {
  const sim::DriveDescription model = read_model((trial.folder / "model.toml").string());
  const Truth truth = read_truth(trial.folder);
  const std::vector<Record> train = read_pieces(trial.train, model.data);
  const std::vector<Record> validate = read_pieces(trial.validate, model.data);
  LeftOut result;
  result.answer = ask(trial.name, "left out", truth, model, train, validate, progress, truth.effects);
  Answer& answer = result.answer;
  const auto is_near = [&](const std::string& claimed) {
    return std::ranges::any_of(truth.effects, [&](const std::string& hidden) {
      const auto& relatives = sim::find_effect(hidden)->confused_with;
      return std::ranges::find(relatives, claimed) != relatives.end();
    });
  };
  answer.outcome = answer.gives_all_clear()                               ? Outcome::wrong
                   : answer.verdict.effects.empty()                       ? Outcome::right
                   : std::ranges::all_of(answer.verdict.effects, is_near) ? Outcome::group
                                                                          : Outcome::wrong;
  const auto goes_with = [&](const std::string& hidden) {
    const auto& along = sim::find_effect(hidden)->along;
    return std::ranges::find(along, answer.verdict.coordinate) != along.end();
  };
  result.right_coordinate = answer.outcome == Outcome::group || std::ranges::any_of(truth.effects, goes_with);
  // Tries the coordinate that the verdict names, as a user would, and the best one in validation.
  for (const std::string& over : {std::string(), answer.verdict.coordinate}) {
    if (!over.empty() && std::ranges::find(sim::kCurveCoordinates, over) == std::end(sim::kCurveCoordinates)) continue;
    try {
      const Addition curve = add_free_curve(model, over, MeasurementGate(model).admit(train, validate));
      const double before = curve.judged.before * curve.judged.before - 1.0;
      const double takes = before > 0.0 ? 1.0 - (curve.judged.after * curve.judged.after - 1.0) / before : 0.0;
      if (!result.over.empty() && takes <= result.curve) continue;
      result.over = curve.judged.model.effects.back().over;
      result.curve = takes;
    } catch (const Failure&) {  // no curve lowers the error
    }
  }
  return result;
}

Answer run_null(std::uint64_t seed, const std::string& name) {
  SimulatedNull null = simulated_null(seed);
  return ask(name, "simulated", {}, null.model, std::move(null.train), std::move(null.validate), {});
}

double error_of_whole_case(const std::filesystem::path& folder) {
  const Trial whole = whole_case(folder, {});
  const sim::DriveDescription model = read_model((folder / "model.toml").string());
  const std::vector<Record> train = read_pieces(whole.train, model.data);
  const std::vector<Record> validate = read_pieces(whole.validate, model.data);
  const PreparedSets sets = prepare_sets(model, pointers(train), pointers(validate));
  const sim::Drive base(sets.base);
  return std::max(error_of(base, sets.training).combined, error_of(base, sets.validation).combined);
}

Reliability reliability_of(const std::vector<Forecast>& forecasts) {
  constexpr std::size_t kBins = 10;
  Reliability result;
  result.bins.resize(kBins);
  for (const auto& [probability, came_true] : forecasts) {
    const auto place = static_cast<std::size_t>(std::clamp(probability, 0.0, 1.0) * kBins);
    Reliability::Bin& bin = result.bins[std::min(kBins - 1, place)];
    ++bin.count;
    bin.forecast += probability;
    bin.came_true += came_true ? 1.0 : 0.0;
  }
  for (Reliability::Bin& bin : result.bins) {
    if (bin.count == 0) continue;
    result.expected_error += std::abs(bin.forecast - bin.came_true) / static_cast<double>(forecasts.size());
    bin.forecast /= static_cast<double>(bin.count);
    bin.came_true /= static_cast<double>(bin.count);
  }
  return result;
}

std::vector<Forecast> top_forecasts(const std::vector<Answer>& answers) {
  std::vector<Forecast> result;
  for (const Answer& answer : answers)
    if (!answer.forecasts.empty()) result.push_back(*std::ranges::max_element(answer.forecasts, {}, &Forecast::first));
  return result;
}

std::vector<Forecast> all_forecasts(const std::vector<Answer>& answers) {
  std::vector<Forecast> result;
  for (const Answer& answer : answers) result.insert(result.end(), answer.forecasts.begin(), answer.forecasts.end());
  return result;
}

}  // namespace host
