#include "host/interchange/portable_model.hpp"

#include <cmath>
#include <numbers>

namespace host {

namespace {

FrictionBend bend_of(const sim::EffectEntry& entry, bool rotary) {
  FrictionBend bend{entry.at("coefficient"), entry.has("exponent") ? entry.at("exponent") : 1.0, rotary ? 10.0 : 0.1};
  if (entry.has("saturation")) bend.saturation = entry.at("saturation");
  return bend;
}

}  // namespace

const std::set<std::string>& portable_kinds() {
  static const std::set<std::string> kKinds{
      "inertia",           "viscous",           "coulomb",         "stribeck", "coulomb_asymmetry",
      "viscous_asymmetry", "nonlinear_viscous", "constant_torque", "cogging",  "spring_torque"};
  return kKinds;
}

PortableModel portable(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  PortableModel result;
  result.name = model.name.empty() ? "axis" : model.name;
  result.data = model.data;
  result.inertia = drive.inertia;
  result.friction = drive.curves();
  for (const sim::EffectEntry& entry : model.effects) {
    if (entry.kind == "nonlinear_viscous") result.bend = bend_of(entry, result.rotary());
    if (entry.kind == "constant_torque") result.constant += entry.at("torque");
    if (entry.kind == "cogging") result.cogging.push_back({entry.at("period"), sim::harmonics_of(entry)});
    if (entry.kind == "spring_torque") {
      result.stiffness = entry.at("stiffness");
      result.centre = entry.at("centre");
    }
  }
  return result;
}

double PortableModel::friction_at(double speed) const {
  if (speed == 0.0) return 0.0;
  const double v = std::abs(speed);
  const sim::SlidingCurve& side = friction[speed > 0.0 ? 0 : 1];
  const double fading = side.rate1 > 0.0 ? std::exp(-v * side.rate1) : 0.0;
  const double rising = side.rate2 > 0.0 ? std::exp(-v * side.rate2) : 0.0;
  double level = side.breakaway * fading + side.coulomb * (1.0 - rising) + side.viscous * v;
  if (bend)
    level += bend->saturation ? -bend->coefficient * std::exp(-v / *bend->saturation)
                              : bend->coefficient * std::pow(v / bend->reference, bend->exponent);
  return std::copysign(level, speed);
}

double PortableModel::slope_at(double speed) const {
  const double v = std::abs(speed);
  const sim::SlidingCurve& side = friction[speed >= 0.0 ? 0 : 1];
  double slope = side.viscous;
  if (side.rate1 > 0.0) slope -= side.breakaway * side.rate1 * std::exp(-v * side.rate1);
  if (side.rate2 > 0.0) slope += side.coulomb * side.rate2 * std::exp(-v * side.rate2);
  if (bend && bend->saturation) slope += bend->coefficient / *bend->saturation * std::exp(-v / *bend->saturation);
  if (bend && !bend->saturation && v > 0.0)
    slope += bend->coefficient * bend->exponent / bend->reference * std::pow(v / bend->reference, bend->exponent - 1.0);
  return slope;
}

double PortableModel::load_at(double x) const {
  double load = constant - stiffness * (x - centre);
  for (const PeriodicTorque& torque : cogging)
    for (const sim::HarmonicTerm& term : torque.orders) {
      const double angle = 2.0 * std::numbers::pi * term.order * x / torque.period;
      load += term.cosine * std::cos(angle) + term.sine * std::sin(angle);
    }
  return load;
}

}  // namespace host
