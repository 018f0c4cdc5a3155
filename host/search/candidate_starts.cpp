#include "host/search/candidate_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <string_view>

#include "host/compare/effort_residual.hpp"
#include "host/evidence/coming_back.hpp"
#include "host/evidence/period_search.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Usual breakaway distances of guides, mm (rolling guides: 5 to 100 um).
constexpr double kBreakawayTravel_mm = 0.02;

/// Dry friction of the lightest drives, relative to the torque or force of the largest command.
constexpr double kLeastFriction = 0.02;

/// A screw of 10 mm pitch that turns at 1 rad/s.
constexpr double kUsualSpeed_mm_s = 10.0 / (2.0 * std::numbers::pi);

double scale_value(sim::Scale scale, const sim::DriveDescription& model, const RecordScales& scales) {
  const sim::Drive drive(model);
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  // A base biased by the missing effect may have no Coulomb friction.
  const double coulomb = std::max(0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb),
                                  kLeastFriction * drive.effort_per_volt * scales.top_command_V);
  const double breakaway_travel = kBreakawayTravel_mm * (rotary ? 1.0 : 1e-3) / model.data.lead;
  switch (scale) {
    case sim::Scale::unity:
      return 1.0;
    case sim::Scale::coulomb:
      return coulomb;
    case sim::Scale::inertia:
      return drive.inertia;
    case sim::Scale::viscous:
      return 0.5 * (drive.friction[0].viscous + drive.friction[1].viscous);
    case sim::Scale::bristle_stiffness:
      return coulomb / breakaway_travel;
    case sim::Scale::bristle_damping:
      return 2.0 * std::sqrt(coulomb / breakaway_travel * drive.inertia);
    case sim::Scale::coulomb_per_travel:
      return coulomb / scales.travel;
    case sim::Scale::stall_effort:
      return drive.effort_per_volt * scales.top_command_V;
    case sim::Scale::stall_current:
      return scales.top_command_V * (rotary ? model.data.amplifier_gain_A_per_V : drive.effort_per_volt);
    case sim::Scale::speed:
      return kUsualSpeed_mm_s * (rotary ? 1.0 : 1e-3) / model.data.lead;
    case sim::Scale::converter_range:
      return model.data.dac_limit_V;
    case sim::Scale::millimetre:
      return rotary ? 1.0 : 1e-3;
    case sim::Scale::top_speed:
      return scales.top_speed;
    case sim::Scale::travel:
    case sim::Scale::position:
      return scales.travel;
    case sim::Scale::duration:
      return scales.duration_s;
    case sim::Scale::first_stamp:
      return scales.first_stamp_s;
  }
  return 1.0;
}

/// The parameters of a new entry: the mandatory ones, and those optional ones that the form of the model's Coulomb
/// friction requires (equal or by direction). Both directions share the Stribeck speeds, which data seldom separate.
std::vector<const sim::ParameterInfo*> parameters_to_start(const sim::EffectInfo& info,
                                                           const sim::DriveDescription& model,
                                                           const RecordScales& scales) {
  const sim::EffectEntry* coulomb = model.find("coulomb");
  const bool by_direction = coulomb != nullptr && coulomb->has("positive");
  std::vector<const sim::ParameterInfo*> chosen;
  for (const sim::ParameterInfo& parameter : info.parameters) {
    const std::string_view id = parameter.id;
    const bool directional = id.ends_with("_positive") || id.ends_with("_negative");
    if (!parameter.optional || id == "exponent" ||
        (parameter.scale == sim::Scale::first_stamp && scales.first_stamp_s != 0.0)) {
      chosen.push_back(&parameter);
    } else if (id.starts_with("omega")) {
      if (!directional) chosen.push_back(&parameter);
    } else if (directional == by_direction && (directional || !parameter.pair_of.empty())) {
      chosen.push_back(&parameter);
    }
  }
  return chosen;
}

sim::EffectEntry entry_from(const sim::EffectInfo& info, const std::vector<const sim::ParameterInfo*>& parameters,
                            const std::vector<double>& values) {
  sim::EffectEntry entry;
  entry.kind = info.kind;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    entry.parameters[std::string(parameters[k]->id)] =
        std::clamp(values[k], parameters[k]->lower, parameters[k]->upper);
  return entry;
}

std::vector<sim::EffectEntry> grid_entries(const sim::EffectInfo& info, const sim::DriveDescription& model,
                                           const RecordScales& scales) {
  const auto parameters = parameters_to_start(info, model, scales);
  std::vector<std::vector<double>> rows{{}};
  // Parameters with equal lists of starts change together (W1 = W2); all others are combined.
  std::vector<std::size_t> follows(parameters.size());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    follows[k] = k;
    for (std::size_t j = 0; j < k && follows[k] == k; ++j)
      if (parameters[k]->starts.size() > 1 && parameters[j]->starts == parameters[k]->starts &&
          parameters[j]->scale == parameters[k]->scale)
        follows[k] = j;
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& row : rows) {
      if (follows[k] != k) {
        longer.push_back(row);
        longer.back().push_back(row[follows[k]]);
        continue;
      }
      for (const double start : parameters[k]->starts) {
        longer.push_back(row);
        longer.back().push_back(start * scale_value(parameters[k]->scale, model, scales) +
                                (parameters[k]->scale == sim::Scale::position ? scales.middle : 0.0));
      }
    }
    rows = std::move(longer);
  }
  std::vector<sim::EffectEntry> entries;
  for (const std::vector<double>& row : rows) entries.push_back(entry_from(info, parameters, row));
  return entries;
}

bool has_speed(const ComparedRecord& compared) { return compared.prepared.record->has_speed(); }
bool has_position(const ComparedRecord& compared) { return compared.prepared.record->has_position(); }

/// Whether a sensor's error is searched for in the tachometer signal (if a record has one); otherwise in the torque.
bool shows_in_speed(const sim::EffectInfo& info, const RecordSet& set) {
  return info.stage == sim::Stage::tachometer ||
         (info.stage == sim::Stage::encoder && std::ranges::any_of(set.records, has_speed));
}

/// Divides the samples by their RMS in each tenth of the speeds, so that those at which the noise is small count most:
/// a fine wave shows in the torque at low speed, and in fast motion the noise of the acceleration covers it.
void divide_by_noise(TravelSignal& signal, const std::vector<double>& speed) {
  constexpr std::size_t kParts = 10;
  std::vector<std::size_t> order(speed.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return speed[k]; });
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t from = part * order.size() / kParts, to = (part + 1) * order.size() / kParts;
    const std::span samples = std::span(order).subspan(from, to - from);
    double square = 0.0;
    for (const std::size_t k : samples) square += signal.value[k] * signal.value[k];
    if (!(square > 0.0)) continue;
    const double noise = std::sqrt(square / static_cast<double>(samples.size()));
    for (const std::size_t k : samples) {
      signal.value[k] /= noise;
      signal.weight[k] /= noise;
    }
  }
}

/// The signal over the travel in which a periodic effect shows, and the weight of its harmonic in this signal.
TravelSignal signal_of(const sim::EffectInfo& info, const sim::DriveDescription& model, const RecordSet& set) {
  // Some 50,000 samples are plenty for a spectrum.
  constexpr std::size_t kSamples = 50000;
  std::size_t rows = 0;
  for (const ComparedRecord& compared : set.records) rows += compared.prepared.u_V.size();
  const bool in_speed = shows_in_speed(info, set);
  TravelSignal signal;
  std::vector<double> speed;
  for (const ComparedRecord& compared : set.records) {
    const ResidualSamples samples =
        residual_samples(model, compared.prepared, std::max<std::size_t>(1, rows / kSamples));
    for (std::size_t k = 0; k < samples.x.size(); ++k) {
      double value = samples.missing[k], weight = 1.0;
      if (info.kind == "torque_ripple") weight = samples.effort[k];
      if (info.kind == "position_dependent_friction") weight = samples.w[k] > 0.0 ? 1.0 : -1.0;
      if (in_speed) {
        if (samples.tach_error.empty()) break;
        value = samples.tach_error[k];
        weight = samples.w[k];
      }
      speed.push_back(std::abs(samples.w[k]));
      signal.x.push_back(samples.x[k]);
      signal.value.push_back(value);
      signal.weight.push_back(weight);
    }
  }
  divide_by_noise(signal, speed);
  return signal;
}

/// Without a tachometer, an encoder error e appears in the force balance through the smoothed motion. At a speed v,
///   missing = (J v^2 e'' + B v e') / lead.
void encoder_error_from_effort(const sim::DriveDescription& model, double v, PeriodPeak& peak) {
  const sim::Drive drive(model);
  const double per_s = 2.0 * std::numbers::pi / peak.period * v;
  const double mass = drive.inertia * per_s * per_s / model.data.lead;
  const double friction = 0.5 * (drive.friction[0].viscous + drive.friction[1].viscous) * per_s / model.data.lead;
  const double square = mass * mass + friction * friction;
  if (!(square > 0.0)) return;
  const double cosine = -(mass * peak.cosine + friction * peak.sine) / square;
  peak.sine = -(mass * peak.sine - friction * peak.cosine) / square;
  peak.cosine = cosine;
}

/// Converts the amplitudes of the signal to those of the effect: an encoder error appears in the speed through its
/// slope; friction and ripple are relative amplitudes.
void convert_amplitudes(const sim::EffectInfo& info, const sim::DriveDescription& model, bool in_speed, double speed,
                        PeriodPeak& peak) {
  if (info.stage == sim::Stage::encoder && !in_speed) {
    encoder_error_from_effort(model, speed, peak);
  } else if (info.stage == sim::Stage::encoder) {
    // The smoothed speed contains w e'(x), so the tachometer reads less than it by this amount.
    const double per_length = peak.period / (2.0 * std::numbers::pi);
    const double cosine = peak.sine * per_length;
    peak.sine = -peak.cosine * per_length;
    peak.cosine = cosine;
  }
  if (info.kind == "position_dependent_friction") {
    const sim::Drive drive(model);
    const double level = 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb);
    peak.cosine /= -level;
    peak.sine /= -level;
  }
}

/// Shortest period that the smoothed motion shows at the usual speed, mm or m.
double shortest_period(const RecordSet& set, double lead) {
  constexpr double kSamplesAPeriod = 8.0;
  double shortest = HUGE_VAL;
  for (const ComparedRecord& compared : set.records) {
    const SmoothedMotion& motion = compared.prepared.motion();
    std::vector<double> speeds;
    for (std::size_t k = 0; k < motion.w.size(); ++k)
      if (!motion.standing[k]) speeds.push_back(std::abs(motion.w[k]));
    if (!speeds.empty())
      shortest = std::min(shortest, kSamplesAPeriod * median(std::move(speeds)) * lead * compared.prepared.period_s);
  }
  return std::isfinite(shortest) ? shortest : 0.0;
}

std::vector<sim::EffectEntry> periodic_entries(const sim::EffectInfo& info, const sim::DriveDescription& model,
                                               const RecordSet& set, const RecordScales& scales) {
  const TravelSignal signal = signal_of(info, model, set);
  constexpr std::size_t kPeaks = 3;
  const bool slow = info.kind == "position_dependent_friction";
  // Fast effects repeat many times over the travel; friction along the travel has at most a few periods.
  const double shortest = slow ? scales.travel / 12.0
                               : std::max({40.0 * model.data.encoder_resolution, scales.travel / 2000.0,
                                           shortest_period(set, model.data.lead)});
  const double longest = slow ? 3.0 * scales.travel : scales.travel / 3.0;
  std::vector<PeriodPeak> peaks = find_periods(signal, shortest, longest, kPeaks);
  std::vector<sim::EffectEntry> entries;
  for (PeriodPeak& peak : peaks) {
    convert_amplitudes(info, model, shows_in_speed(info, set), scales.top_speed * model.data.lead, peak);
    entries.push_back(
        {std::string(info.kind), {{"cosine", peak.cosine}, {"sine", peak.sine}, {"period", peak.period}}, {}, {}});
  }
  return entries;
}

constexpr std::array kContacts = {"presliding", "compliance", "backlash"};

}  // namespace

RecordScales scales_of(const RecordSet& set) {
  RecordScales scales;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const ComparedRecord& compared : set.records) {
    const SmoothedMotion& motion = compared.prepared.motion();
    for (std::size_t k = 0; k < motion.x.size(); ++k) {
      low = std::min(low, motion.x[k]);
      high = std::max(high, motion.x[k]);
      scales.top_speed = std::max(scales.top_speed, std::abs(motion.w[k]));
      scales.top_command_V = std::max(scales.top_command_V, std::abs(compared.prepared.u_V[k]));
    }
    const std::vector<double>& t_s = compared.prepared.record->t_s;
    scales.duration_s = std::max(scales.duration_s, t_s.back() - t_s.front());
  }
  scales.travel = high - low;
  scales.middle = 0.5 * (high + low);
  scales.first_stamp_s = first_stamp_s(set);
  return scales;
}

bool is_applicable(const sim::EffectInfo& info, const sim::DriveDescription& model, const RecordSet& set) {
  // A drive may have several periods with different phases.
  if (info.base || (model.find(info.kind) != nullptr && !info.periodic)) return false;
  const sim::EffectEntry* coulomb = model.find("coulomb");
  if (info.kind == "coulomb_asymmetry") return coulomb != nullptr && coulomb->has("level");
  if (info.kind == "viscous_asymmetry") return model.find("viscous") != nullptr;
  if (info.curve) return false;                      // gives no cause, so it is never found
  if (info.kind == "external_torque") return false;  // acts at one time, so no other record shows it
  const auto returns = [](const ComparedRecord& compared) { return comes_back(*compared.prepared.record); };
  if (info.kind == "spring_torque" && std::ranges::none_of(set.records, returns)) return false;
  if (info.stage == sim::Stage::table) return false;  // not visible at the motor
  if (set.measure == Measure::effort && info.stage == sim::Stage::tachometer) return false;
  if (info.stage == sim::Stage::tachometer)
    return std::ranges::all_of(set.records, has_speed) && std::ranges::all_of(set.records, has_position);
  if (info.stage == sim::Stage::encoder || info.periodic) return std::ranges::all_of(set.records, has_position);
  return std::ranges::none_of(model.effects, [&](const sim::EffectEntry& entry) {
    return exclude_each_other(info, *sim::find_effect(entry.kind));
  });
}

bool exclude_each_other(const sim::EffectInfo& a, const sim::EffectInfo& b) {
  return a.kind == b.kind || (std::ranges::find(kContacts, a.kind) != kContacts.end() &&
                              std::ranges::find(kContacts, b.kind) != kContacts.end());
}

std::vector<sim::DriveDescription> starting_models(const sim::EffectInfo& info, const sim::DriveDescription& model,
                                                   const RecordSet& set) {
  const RecordScales scales = scales_of(set);
  std::vector<sim::DriveDescription> models;
  for (sim::EffectEntry& entry :
       info.periodic ? periodic_entries(info, model, set, scales) : grid_entries(info, model, scales)) {
    models.push_back(model);
    models.back().effects.push_back(std::move(entry));
  }
  return models;
}

}  // namespace host
