#include "host/scoreboard/rewriting.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "host/diagnose/diagnosis.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/fit/model_fit.hpp"
#include "host/model/model_file.hpp"
#include "host/record/columns.hpp"

namespace host {

namespace {

void scale(std::vector<double>& channel, double factor) {
  for (double& value : channel) value *= factor;
}

template <typename Change>
void for_each_record(Question& question, const Change& change) {
  for (auto* records : {&question.train, &question.validate})
    for (Record& record : *records) change(record);
}

void rescale_volt(Question& question, double volts_per_volt) {
  sim::DataSheet& data = question.model.data;
  data.amplifier_gain_A_per_V /= volts_per_volt;
  data.force_constant_N_per_V /= volts_per_volt;
  data.dac_resolution_V *= volts_per_volt;
  data.dac_limit_V *= volts_per_volt;
  for_each_record(question, [&](Record& record) { scale(record.u_V, volts_per_volt); });
}

/// Converts a base parameter of a rotary drive to the linear drive with the same motion of the table: torque divided by
/// lead, speed times lead.
double in_linear_units(double lead_m, std::string_view id, double value) {
  if (id.starts_with("omega")) return value * lead_m;
  return id == "J" || id == "B" ? value / (lead_m * lead_m) : value / lead_m;
}

double metres_a_radian(const Question& question) { return 1e-3 * question.model.data.lead; }

/// Converts a rotary model with base effects only, and its records, to a linear drive.
void make_linear(Question& question) {
  sim::DataSheet& data = question.model.data;
  if (data.kind == sim::DriveKind::linear) return;
  const double lead_m = metres_a_radian(question);
  for (sim::EffectEntry& entry : question.model.effects) {
    for (auto& [id, value] : entry.parameters) value = in_linear_units(lead_m, id, value);
    entry.ci95.clear();
  }
  data.force_constant_N_per_V = data.effort_per_volt() / lead_m;
  data.kind = sim::DriveKind::linear;
  data.amplifier_gain_A_per_V = data.torque_constant_Nm_per_A = 0.0;
  data.lead = 1.0;
  for (double* length : {&data.encoder_resolution, &data.load_encoder_resolution, &data.load_encoder_cyclic_error,
                         &data.load_encoder_cyclic_period, &data.load_encoder_offset_per_K})
    *length *= 1e-3;
  if (data.tach_noise_variance) *data.tach_noise_variance *= lead_m * lead_m;
  for_each_record(question, [&](Record& record) {
    record.kind = sim::DriveKind::linear;
    for (auto* positions : {&record.x, &record.x2, &record.x_ref}) scale(*positions, 1e-3);
    for (auto* speeds : {&record.w, &record.w_ref}) scale(*speeds, lead_m);
    for (std::string& column : record.columns)
      column = column == "w_rad_s" ? "v_m_s" : column == "x_mm" ? "x_m" : column == "x2_mm" ? "x2_m" : column;
  });
}

/// The corresponding parameter of the other direction; the same parameter if both directions share it.
std::string other_direction(std::string id) {
  constexpr std::string_view kForward = "positive", kBackward = "negative";
  for (const auto& [from, to] : {std::pair{kForward, kBackward}, {kBackward, kForward}})
    if (id.ends_with(from)) return id.replace(id.size() - from.size(), from.size(), to);
  return id;
}

/// Exchanges the directions; values of the backward direction are negative.
void mirror(Question& question) {
  for (sim::EffectEntry& entry : question.model.effects) {
    const std::map<std::string, double> original = entry.parameters;
    for (auto& [id, value] : entry.parameters) {
      const std::string other = other_direction(id);
      if (other != id) value = -original.at(other);
    }
  }
  for_each_record(question, [](Record& record) {
    for (auto* channel : {&record.u_V, &record.i_A, &record.x, &record.x2, &record.w, &record.x_ref, &record.w_ref})
      scale(*channel, -1.0);
  });
}

void shift_time(Question& question) {
  constexpr double kLater_s = 1000.0;
  for_each_record(question, [](Record& record) {
    for (double& t_s : record.t_s) t_s += kLater_s;
  });
}

void cut_in_two(Question& question) {
  Record& first = question.train.front();
  Record second = first;
  const auto half = static_cast<std::ptrdiff_t>(first.size() / 2);
  for (const auto channel : kChannelsInFileOrder) {
    if ((first.*channel).empty()) continue;
    (second.*channel).erase((second.*channel).begin(), (second.*channel).begin() + half);
    (first.*channel).resize(static_cast<std::size_t>(half));
  }
  first.extra.clear();
  second.extra.clear();
  second.path += ", second half";
  question.train.push_back(std::move(second));
}

double mirrored(const Question& original, std::string_view id, double value) {
  const std::string other = other_direction(std::string(id));
  return other == id ? value : -original.model.find("coulomb")->at(other);
}

struct Answered {
  std::string words;
  Question question;  ///< with the refitted base
  double error = 0.0;
};

Answered answer(Question question) {
  const Measurements measured = MeasurementGate(question.model).admit(question.train, question.validate);
  Diagnosis diagnosis = diagnose(question.model, measured);
  std::vector<std::string> effects = diagnosis.verdict.effects;
  std::ranges::sort(effects);
  estimate_intervals(diagnosis.best, diagnosis.training);
  question.model = diagnosis.best;
  return {fmt::format("{} {}", status_name(diagnosis.verdict.status), fmt::join(effects, ", ")), std::move(question),
          diagnosis.after_validate};
}

}  // namespace

Question read_question(const Trial& trial) {
  Question question{read_model((trial.folder / "model.toml").string()), {}, {}};
  for (const Piece& piece : trial.train) question.train.push_back(read_piece(piece, question.model.data));
  for (const Piece& piece : trial.validate) question.validate.push_back(read_piece(piece, question.model.data));
  return question;
}

std::span<const Rewriting> rewritings() {
  static const std::array all{
      Rewriting{"volt x 100", [](Question& question) { rescale_volt(question, 100.0); }},
      Rewriting{"volt x 0.01", [](Question& question) { rescale_volt(question, 0.01); }},
      Rewriting{"linear", make_linear,
                [](const Question& original, std::string_view id, double value) {
                  return original.model.data.kind == sim::DriveKind::linear
                             ? value
                             : in_linear_units(metres_a_radian(original), id, value);
                }},
      Rewriting{"mirrored", mirror, mirrored},
      Rewriting{"later", shift_time},
      Rewriting{"reordered", [](Question& question) { std::ranges::reverse(question.train); }},
      Rewriting{"cut in two", cut_in_two},
      Rewriting{"given twice", [](Question& question) { question.train.push_back(question.train.front()); }},
  };
  return all;
}

std::vector<Invariance> try_rewritings(const Question& question, std::span<const Rewriting> chosen) {
  const Answered original = answer(question);
  std::vector<Invariance> results;
  for (const Rewriting& rewriting : chosen) {
    Question anew = question;
    rewriting.apply(anew);
    const Answered rewritten = answer(std::move(anew));
    Invariance result;
    result.original = original.words;
    result.rewritten = rewritten.words;
    result.same_verdict = original.words == rewritten.words;
    result.error_ratio = std::max(original.error, rewritten.error) / std::min(original.error, rewritten.error);
    for (const char* kind : {"inertia", "viscous", "coulomb"}) {
      const sim::EffectEntry* before = original.question.model.find(kind);
      const sim::EffectEntry* after = rewritten.question.model.find(kind);
      if (before == nullptr || after == nullptr) continue;
      for (const auto& [id, value] : before->parameters) {
        const double expected = rewriting.expected ? rewriting.expected(original.question, id, value) : value;
        const auto interval = after->ci95.find(id), original_interval = before->ci95.find(id);
        if (!after->has(id) || interval == after->ci95.end() || original_interval == before->ci95.end()) continue;
        const auto half = [](const std::array<double, 2>& ci95) { return 0.5 * (ci95[1] - ci95[0]); };
        const double scale = std::abs(value) > 0.0 ? std::abs(expected / value) : 1.0;
        result.worst_parameter =
            std::max(result.worst_parameter, std::abs(after->at(id) - expected) /
                                                 (half(interval->second) + scale * half(original_interval->second)));
      }
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace host
