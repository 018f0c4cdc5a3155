#include "host/effort/effort_terms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/effort/effort_waves.hpp"
#include "host/evidence/coming_back.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/identify/motion.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd sign_of(const VectorXd& values) {
  return values.unaryExpr([](double value) { return value > 0.0 ? 1.0 : -1.0; });
}

bool in_bounds(const sim::EffectEntry& entry) {
  const sim::EffectInfo& info = *sim::find_effect(entry.kind);
  return std::ranges::all_of(entry.parameters, [&](const auto& parameter) {
    const sim::ParameterInfo& known = *info.parameter(parameter.first);
    return std::isfinite(parameter.second) && parameter.second >= known.lower && parameter.second <= known.upper;
  });
}

bool append(sim::DriveDescription& model, std::string_view kind, const std::map<std::string, double>& parameters) {
  sim::EffectEntry entry;
  entry.kind = kind;
  entry.parameters = parameters;
  return append_within_bounds(model, std::move(entry));
}

bool is_linear(const sim::EffectEntry& entry) {
  constexpr std::string_view kLinear[] = {"constant_torque", "dac_offset", "cogging", "encoder_cyclic_error"};
  return std::ranges::find(kLinear, entry.kind) != std::end(kLinear);
}

/// A term with one column. `write` gets its factor and the model with the fitted base.
EffortTerm simple(std::string kind, const VectorXd& column, int sign,
                  std::function<bool(double factor, sim::DriveDescription&)> write) {
  return {std::move(kind),
          column,
          {sign},
          [write](const VectorXd& factors, sim::DriveDescription& model) { return write(factors(0), model); },
          {}};
}

/// Friction that decreases with speed: the part above the Coulomb level. `by_direction`: the model has a level for each
/// direction.
EffortTerm stribeck_term(bool by_direction, const EffortRows& rows, double fading) {
  const VectorXd shape = (-rows.w.array().abs() / fading).exp();
  EffortTerm term{"stribeck", {}, {}, {}, {}};
  term.neighbours = [by_direction, &rows, fading](double part) {
    const auto with = [&](double factor) {
      return [by_direction, &rows, other = fading * factor] { return stribeck_term(by_direction, rows, other); };
    };
    return std::vector<std::function<EffortTerm()>>{with(1.0 + part), with(1.0 - part)};
  };
  if (by_direction) {
    term.columns.resize(rows.w.size(), 2);
    term.columns.col(0) = (rows.w.array() > 0.0).select(shape, 0.0);
    term.columns.col(1) = (rows.w.array() > 0.0).select(VectorXd::Zero(rows.w.size()), -shape);
    term.sign = {1, 1};
    term.write = [fading](const VectorXd& factors, sim::DriveDescription& fitted) {
      const sim::EffectEntry& base = *fitted.find("coulomb");
      return append(fitted, "stribeck",
                    {{"static_positive", base.at("positive") + factors(0)},
                     {"static_negative", base.at("negative") - factors(1)},
                     {"omega1", fading},
                     {"omega2", fading}});
    };
    return term;
  }
  term.columns = sign_of(rows.w).cwiseProduct(shape);
  term.sign = {1};
  term.write = [fading](const VectorXd& factors, sim::DriveDescription& fitted) {
    const double level = fitted.find("coulomb") == nullptr ? 0.0 : fitted.find("coulomb")->at("level");
    return append(fitted, "stribeck", {{"static", level + factors(0)}, {"omega1", fading}, {"omega2", fading}});
  };
  return term;
}

/// A force towards a centre within the travel, proportional to the distance.
EffortTerm spring_term(const EffortRows& rows, double centre) {
  EffortTerm term =
      simple("spring_torque", rows.x.array() - centre, 0, [centre](double stiffness, sim::DriveDescription& fitted) {
        return append(fitted, "spring_torque", {{"stiffness", stiffness}, {"centre", centre}});
      });
  term.neighbours = [&rows, centre](double part) {
    const double low = rows.x.minCoeff(), high = rows.x.maxCoeff(), step = part * (high - low);
    const auto around = [&](double other) { return [&rows, other] { return spring_term(rows, other); }; };
    return std::vector<std::function<EffortTerm()>>{around(std::min(centre + step, high)),
                                                    around(std::max(centre - step, low))};
  };
  return term;
}

/// The part of a command above the amplifier's limit. Its factor must be 1; another value means another effect.
EffortTerm current_limit_term(const sim::DriveDescription& model, const EffortRows& rows, double limit) {
  VectorXd given(rows.w.size());
  sim::DriveDescription standing = standing_part(model);
  std::erase_if(standing.effects, [](const sim::EffectEntry& entry) { return entry.parameters.empty(); });  // chosen
  const sim::Drive path(standing);
  const double most_V = limit / model.data.effort_per_volt();
  for (const EffortSignals& signals : rows.signals) {
    Record limited;
    limited.path = signals.record->path;
    limited.sample_period_s = signals.record->sample_period_s;
    limited.x = signals.record->x;
    limited.u_V = signals.record->u_V;
    for (double& u_V : limited.u_V) u_V = std::clamp(u_V, -most_V, most_V);
    const std::vector<double> effort = delivered_effort(limited, model.data, signals.cutoff_Hz, true, &path).effort;
    for (std::size_t k = 0; k < signals.kept.size(); ++k)
      given(static_cast<Index>(signals.first_row + k)) = effort[signals.kept[k]];
  }
  EffortTerm term{"current_saturation", rows.effort - given, {1}, {}, {}};
  term.acting = given.norm() / rows.effort.norm();
  const double per_ampere = model.data.kind == sim::DriveKind::rotary ? model.data.torque_constant_Nm_per_A : 1.0;
  term.write = [limit, per_ampere](const VectorXd& factors, sim::DriveDescription& fitted) {
    constexpr double kNearly = 1.25;
    return factors(0) > 1.0 / kNearly && factors(0) < kNearly &&
           append(fitted, "current_saturation", {{"limit", limit / per_ampere}});
  };
  term.neighbours = [model, &rows, limit](double part) {
    const auto with = [&](double factor) {
      return [model, &rows, other = limit * factor] { return current_limit_term(model, rows, other); };
    };
    return std::vector<std::function<EffortTerm()>>{with(1.0 + part), with(1.0 - part)};
  };
  return term;
}

}  // namespace

double coulomb_level(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  return 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb);
}

std::vector<const EffortTerm*> pointers_to(const std::vector<EffortTerm>& terms) {
  std::vector<const EffortTerm*> pointers;
  for (const EffortTerm& term : terms) pointers.push_back(&term);
  return pointers;
}

bool append_within_bounds(sim::DriveDescription& model, sim::EffectEntry entry) {
  if (!in_bounds(entry)) return false;
  model.effects.push_back(std::move(entry));
  return true;
}

std::vector<EffortTerm> base_terms(const sim::DriveDescription& model, const EffortRows& rows) {
  std::vector<EffortTerm> terms;
  const VectorXd direction = sign_of(rows.w);
  const auto set = [](std::string kind, std::string id, double sign) {
    return [=](const VectorXd& factors, sim::DriveDescription& fitted) {
      fitted.find(kind)->parameters[id] = sign * factors(0);
      return true;
    };
  };
  terms.push_back({"inertia", rows.acceleration, {1}, set("inertia", "J", 1.0), {}});
  if (model.find("viscous") != nullptr) terms.push_back({"viscous", rows.w, {1}, set("viscous", "B", 1.0), {}});
  if (const sim::EffectEntry* coulomb = model.find("coulomb")) {
    if (coulomb->has("level")) {
      terms.push_back({"coulomb", direction, {1}, set("coulomb", "level", 1.0), {}});
    } else {
      const VectorXd forward = 0.5 * (1.0 + direction.array()), backward = 0.5 * (direction.array() - 1.0);
      terms.push_back({"coulomb", forward, {1}, set("coulomb", "positive", 1.0), {}});
      terms.push_back({"coulomb", backward, {1}, set("coulomb", "negative", -1.0), {}});
    }
  }
  for (const sim::EffectEntry& entry : model.effects) {
    if (entry.kind == "constant_torque" || entry.kind == "dac_offset") {
      const bool volts = entry.kind == "dac_offset";
      const double per_unit = volts ? -model.data.effort_per_volt() : -1.0;
      const std::string id = volts ? "offset" : "torque";
      terms.push_back({entry.kind, VectorXd::Constant(rows.w.size(), per_unit), {0}, set(entry.kind, id, 1.0), {}});
    } else if (is_linear(entry) && rows.has_position) {
      // Parameters that these rows cannot determine keep their given value.
      if (entry.kind != "cogging" && (rows.by_speed || rows.steady)) continue;
      const std::vector<sim::HarmonicTerm> harmonics = sim::harmonics_of(entry);
      std::vector<double> orders;
      for (const sim::HarmonicTerm& term : harmonics) orders.push_back(term.order);
      MatrixXd columns(rows.w.size(), 2 * static_cast<Index>(orders.size()));
      for (std::size_t n = 0; n < orders.size(); ++n)
        columns.middleCols(2 * static_cast<Index>(n), 2) =
            entry.kind == "cogging"
                ? wave_columns(rows, VectorXd::Constant(rows.w.size(), -1.0), {entry.at("period"), orders[n]})
                : encoder_error_columns(model, rows, {entry.at("period"), orders[n]});
      const auto index = static_cast<std::size_t>(&entry - model.effects.data());
      EffortTerm term{entry.kind,
                      columns,
                      std::vector<int>(2 * orders.size(), 0),
                      [orders, index, &model](const VectorXd& factors, sim::DriveDescription& fitted) {
                        const double unit =
                            model.effects[index].kind == "cogging" ? 1.0 : encoder_error_unit(model, fitted);
                        std::vector<sim::HarmonicTerm> found;
                        for (std::size_t n = 0; n < orders.size(); ++n)
                          found.push_back({orders[n], factors(2 * static_cast<Index>(n)) / unit,
                                           factors(2 * static_cast<Index>(n) + 1) / unit});
                        sim::set_harmonics(fitted.effects[index], found);
                        return true;
                      },
                      {}};
      terms.push_back(std::move(term));
    }
  }
  if (rows.timing_deviation > 0.0) {
    // If an offset was estimated with inertia and friction alone, any missing effect may have biased it, so it is not
    // used as a prior. If no offset was estimated, the prior is a part of a sample; a longer offset is a delay, which
    // is an effect.
    constexpr double kPart = 0.25;
    EffortTerm timing{"effort_timing", rows.effort_per_sample, {0}, [](const VectorXd&, auto&) { return true; }, {}};
    timing.deviation = rows.timing_deviation < kBelievedTiming.deviation ? kBelievedTiming.deviation : kPart;
    terms.push_back(std::move(timing));
  }
  return terms;
}

namespace {

bool is_base(const sim::EffectEntry& entry) { return sim::find_effect(entry.kind)->base; }

}  // namespace

bool has_linear_form(const sim::DriveDescription& model) {
  return std::ranges::all_of(model.effects,
                             [](const sim::EffectEntry& entry) { return is_base(entry) || is_linear(entry); });
}

sim::DriveDescription standing_part(const sim::DriveDescription& model) {
  sim::DriveDescription standing = model;
  std::erase_if(standing.effects, is_linear);
  return standing;
}

VectorXd standing_effort(const sim::DriveDescription& model, const EffortRows& rows) {
  if (has_linear_form(model)) return VectorXd::Zero(rows.w.size());
  const sim::DriveDescription standing = standing_part(model);
  sim::DriveDescription base = standing;
  std::erase_if(base.effects, [](const sim::EffectEntry& entry) { return !is_base(entry); });
  const auto list = [](const VectorXd& values) { return std::vector<double>(values.begin(), values.end()); };
  Motion motion;
  motion.t_s = list(rows.t_s);
  motion.travel = list(rows.x);
  motion.speed = list(rows.w);
  motion.acceleration = list(rows.acceleration);
  motion.effort = list(rows.effort);
  const std::vector<double> with = inverse_effort(sim::Drive(standing), motion);
  const std::vector<double> without = inverse_effort(sim::Drive(base), motion);
  return Eigen::Map<const VectorXd>(with.data(), rows.w.size()) -
         Eigen::Map<const VectorXd>(without.data(), rows.w.size());
}

std::vector<EffortTerm> shaped_terms(const sim::DriveDescription& model, const EffortRows& rows,
                                     const VectorXd& explained) {
  std::vector<EffortTerm> terms;
  const VectorXd direction = sign_of(rows.w), speed = rows.w.cwiseAbs(), one = VectorXd::Ones(rows.w.size());
  const double top = speed.maxCoeff();
  const auto may_have = [&](std::string_view kind) { return model.find(kind) == nullptr; };
  const bool has_offset = !may_have("constant_torque") || !may_have("dac_offset") || !may_have("coulomb_asymmetry");
  const sim::EffectEntry* coulomb = model.find("coulomb");

  if (!has_offset) {
    terms.push_back(simple("constant_torque", -one, 0, [](double torque, sim::DriveDescription& fitted) {
      return append(fitted, "constant_torque", {{"torque", torque}});
    }));
    const double per_volt = model.data.effort_per_volt();
    terms.push_back(simple("dac_offset", -per_volt * one, 0, [](double offset, sim::DriveDescription& fitted) {
      return append(fitted, "dac_offset", {{"offset", offset}});
    }));
    if (coulomb != nullptr && coulomb->has("level"))
      terms.push_back(simple("coulomb_asymmetry", one, 0, [](double difference, sim::DriveDescription& fitted) {
        const double level = coulomb_level(fitted);
        return level > 0.0 && append(fitted, "coulomb_asymmetry", {{"asymmetry", difference / level}});
      }));
  }
  if (may_have("viscous_asymmetry") && model.find("viscous") != nullptr)
    terms.push_back(simple("viscous_asymmetry", speed, 0, [](double difference, sim::DriveDescription& fitted) {
      const double viscous = fitted.find("viscous")->at("B");
      return viscous > 0.0 && append(fitted, "viscous_asymmetry", {{"asymmetry", difference / viscous}});
    }));
  if (may_have("nonlinear_viscous")) {
    const double reference = model.data.kind == sim::DriveKind::rotary ? 10.0 : 0.1;
    for (const double exponent : {0.33, 0.5, 1.5, 2.0, 3.0})
      terms.push_back(
          simple("nonlinear_viscous", direction.array() * (speed.array() / reference).pow(exponent), 0,
                 [exponent](double coefficient, sim::DriveDescription& fitted) {
                   return append(fitted, "nonlinear_viscous", {{"coefficient", coefficient}, {"exponent", exponent}});
                 }));
  }
  if (may_have("nonlinear_viscous"))
    for (const double part : {0.05, 0.08, 0.12, 0.2, 0.4}) {
      const double saturation = part * top;
      // Only curves that become flatter: friction that decreases with speed is Stribeck friction.
      terms.push_back(simple(
          "nonlinear_viscous", -direction.array() * (-speed.array() / saturation).exp(), 1,
          [saturation](double coefficient, sim::DriveDescription& fitted) {
            return append(fitted, "nonlinear_viscous", {{"coefficient", coefficient}, {"saturation", saturation}});
          }));
    }
  if (may_have("stribeck") && coulomb != nullptr)
    for (const double part : {0.02, 0.05, 0.08, 0.12, 0.2})
      terms.push_back(stribeck_term(coulomb->has("positive"), rows, part * top));
  if (may_have("load_dependent_friction"))
    terms.push_back(simple("load_dependent_friction", direction.cwiseProduct(explained.cwiseAbs()), 1,
                           [](double share, sim::DriveDescription& fitted) {
                             return append(fitted, "load_dependent_friction", {{"coefficient", share}});
                           }));
  if (may_have("dac_dead_zone"))
    terms.push_back(simple("dac_dead_zone", model.data.effort_per_volt() * sign_of(explained), 1,
                           [](double width, sim::DriveDescription& fitted) {
                             return append(fitted, "dac_dead_zone", {{"width", width}});
                           }));
  // At steady speeds all rows have the mean speed. A command that is cut to a constant would fit best there, so these
  // effects are left out.
  if (rows.commanded && !rows.steady && may_have("current_saturation") && may_have("voltage_limit")) {
    const double most = rows.effort.cwiseAbs().maxCoeff();
    for (const double part : {0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95})
      terms.push_back(current_limit_term(model, rows, part * most));
  }
  if (may_have("thermal_friction_drift") && coulomb != nullptr) {
    const double duration_s = rows.t_s.maxCoeff() - rows.t_s.minCoeff();
    for (const double part : {0.2, 1.0}) {
      const double tau = part * duration_s;
      const double cold_s = rows.first_stamp_s;
      const VectorXd warmth = 1.0 - (-(rows.t_s.array() - cold_s) / tau).exp();
      terms.push_back(simple("thermal_friction_drift", direction.cwiseProduct(warmth), 0,
                             [tau, cold_s](double change, sim::DriveDescription& fitted) {
                               const double level = coulomb_level(fitted);
                               std::map<std::string, double> drift{
                                   {"coulomb_change", change / level}, {"viscous_change", 0.0}, {"time_constant", tau}};
                               if (cold_s != 0.0) drift["cold_start"] = cold_s;
                               return level > 0.0 && append(fitted, "thermal_friction_drift", drift);
                             }));
    }
  }
  if (!rows.steady && may_have("input_delay") && may_have("current_loop_lag")) {
    // T(t - d) = explained: the command leads the acting torque by d times its slope. The slope is that of the torque
    // of inertia and friction, which contains no measurement noise.
    VectorXd slope = VectorXd::Zero(rows.w.size());
    for (Index k = 1; k + 1 < rows.w.size(); ++k) {
      const double step_s = rows.t_s(k + 1) - rows.t_s(k - 1);
      const bool together =
          rows.record[static_cast<std::size_t>(k - 1)] == rows.record[static_cast<std::size_t>(k + 1)];
      constexpr double kGap_s = 0.1;  // rows before and after a stop are not adjacent
      if (together && step_s > 0.0 && step_s < kGap_s) slope(k) = (explained(k + 1) - explained(k - 1)) / step_s;
    }
    terms.push_back(simple("input_delay", slope, 1, [](double delay_s, sim::DriveDescription& fitted) {
      return delay_s >= 0.0 && append(fitted, "input_delay", {{"delay", delay_s}});
    }));
    terms.push_back(simple("current_loop_lag", slope, 1, [](double lag_s, sim::DriveDescription& fitted) {
      return lag_s > 0.0 && append(fitted, "current_loop_lag", {{"bandwidth", 1.0 / (2.0 * std::numbers::pi * lag_s)}});
    }));
  }
  if (!rows.has_position) return terms;
  // A spring with its equilibrium outside the travel is a weight plus a spring with its equilibrium inside.
  constexpr int kCentres = 5;
  const bool returns =
      std::ranges::any_of(rows.signals, [](const EffortSignals& one) { return comes_back(*one.record); });
  if (returns && may_have("spring_torque"))
    for (int k = 0; k < kCentres; ++k)
      terms.push_back(
          spring_term(rows, rows.x.minCoeff() + (rows.x.maxCoeff() - rows.x.minCoeff()) * k / (kCentres - 1)));
  return terms;
}

}  // namespace host
