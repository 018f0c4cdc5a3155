#include "host/axes/path_command.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "host/identify/inverse_model.hpp"

namespace host {

namespace {

sim::EffectEntry effect(const char* kind, std::map<std::string, double> parameters) {
  return {.kind = kind, .parameters = std::move(parameters), .ci95 = {}, .from = {}};
}

/// Computes the command that one drive needs along the path, point by point.
class NeedAlongPath {
 public:
  NeedAlongPath(const sim::DriveDescription& model, double unit_mm, std::size_t axis)
      : drive_(model), full_(drive_.effort_per_volt * model.data.dac_limit_V), mm_(unit_mm), axis_(axis) {
    motion_.t_s = motion_.travel = motion_.speed = motion_.acceleration = motion_.effort = {0.0};
    need_.axis = firmware::kAxisNames.at(axis);
  }

  void at(const PathKnot& point) {
    const auto k = static_cast<Eigen::Index>(axis_);
    const double per_turn = mm_ * drive_.lead;
    motion_.travel[0] = point.position[k] / mm_;
    motion_.speed[0] = point.velocity[k] / per_turn;
    motion_.acceleration[0] = point.acceleration[k] / per_turn;
    double effort = inverse_effort(drive_, motion_).front();
    effort += std::copysign(drive_.transmitted_share * std::abs(effort), motion_.speed[0]);
    double most = std::copysign(full_, effort);
    for (const auto& limit : drive_.effort_limit) most = limit(most, motion_.speed[0]);
    const double share = std::abs(effort / most);
    if (!(share > share_)) return;
    share_ = share;
    need_.command_V = std::abs(effort) / drive_.effort_per_volt;
    need_.limit_V = std::abs(most) / drive_.effort_per_volt;
    need_.time_s = point.time_s;
    need_.position_mm = point.position[k];
    need_.speed_mm_s = point.velocity[k];
    need_.acceleration_mm_s2 = point.acceleration[k];
  }

  const CommandNeed& need() const { return need_; }

 private:
  sim::Drive drive_;
  double full_, mm_, share_ = -1.0;
  std::size_t axis_;
  Motion motion_;
  CommandNeed need_;
};

}  // namespace

std::optional<sim::DriveDescription> drive_of_parameters(const firmware::AxisValues& v, std::string_view axis) {
  const double a22 = static_cast<double>(v.get<"model.a22">()), b2 = static_cast<double>(v.get<"model.b2">());
  if (!(a22 > 0.0) || !(b2 > 0.0)) return {};
  sim::DriveDescription drive;
  drive.name = axis;
  sim::DataSheet& data = drive.data;
  data.sample_period_s = static_cast<double>(v.get<"drive.sample_period">());
  data.amplifier_gain_A_per_V = 1.0;
  data.torque_constant_Nm_per_A = static_cast<double>(v.get<"drive.effort_per_volt">());
  data.lead = static_cast<double>(v.get<"drive.lead">());
  data.dac_limit_V = static_cast<double>(v.get<"drive.dac_limit">());
  // Eq. (7): a22 = exp(-B Ts / J), b2 = Kw (1 - a22) / (B / J).
  const double rate = -std::log(a22) / data.sample_period_s;
  const double held_s = rate > 0.0 ? (1.0 - a22) / rate : data.sample_period_s;
  const double inertia = data.effort_per_volt() * held_s / b2;
  const auto value = [](float one) { return static_cast<double>(one); };
  const double further = value(std::max(v.get<"friction.viscous_positive">(), v.get<"friction.viscous_negative">()));
  drive.effects = {effect("inertia", {{"J", inertia}}), effect("viscous", {{"B", rate * inertia + further}}),
                   effect("coulomb", {{"positive", value(v.get<"friction.coulomb_positive">())},
                                      {"negative", -value(v.get<"friction.coulomb_negative">())}}),
                   effect("stribeck", {{"static_positive", value(v.get<"friction.static_positive">())},
                                       {"static_negative", -value(v.get<"friction.static_negative">())},
                                       {"omega1_positive", value(v.get<"friction.omega1_positive">())},
                                       {"omega1_negative", -value(v.get<"friction.omega1_negative">())},
                                       {"omega2_positive", value(v.get<"friction.omega2_positive">())},
                                       {"omega2_negative", -value(v.get<"friction.omega2_negative">())}})};
  if (!v.get<"cogging.on">()) return drive;
  const auto cogging = [&](float cosine, float sine, float period) {
    if (cosine != 0.0F || sine != 0.0F)
      drive.effects.push_back(
          effect("cogging", {{"cosine", value(cosine)}, {"sine", value(sine)}, {"period", value(period)}}));
  };
  cogging(v.get<"cogging.cosine_1">(), v.get<"cogging.sine_1">(), v.get<"cogging.period_1">());
  cogging(v.get<"cogging.cosine_2">(), v.get<"cogging.sine_2">(), v.get<"cogging.period_2">());
  cogging(v.get<"cogging.cosine_3">(), v.get<"cogging.sine_3">(), v.get<"cogging.period_3">());
  return drive;
}

std::vector<CommandNeed> largest_commands(const PlannedPath& path, const PathScale& scale,
                                          const std::vector<std::optional<sim::DriveDescription>>& drives) {
  constexpr int kParts = 8;  // checked intervals between two knots
  std::vector<CommandNeed> needs;
  for (std::size_t axis = 0; axis < drives.size(); ++axis) {
    if (!drives[axis]) continue;
    const bool in_metres = drives[axis]->data.kind == sim::DriveKind::linear;
    NeedAlongPath along(*drives[axis], in_metres ? 1000.0 : scale.unit_mm.at(axis), axis);
    for (std::size_t k = 0; k + 1 < path.knots.size(); ++k)
      for (int part = 0; part <= kParts; ++part)
        along.at(between(path.knots[k], path.knots[k + 1],
                         path.knots[k].time_s + (path.knots[k + 1].time_s - path.knots[k].time_s) * part / kParts));
    needs.push_back(along.need());
    needs.back().line = line_at(path, needs.back().time_s);
  }
  return needs;
}

nlohmann::json commands_json(const std::vector<CommandNeed>& needs) {
  nlohmann::json list = nlohmann::json::array();
  for (const CommandNeed& need : needs)
    list.push_back({{"axis", need.axis},
                    {"command_V", need.command_V},
                    {"limit_V", need.limit_V},
                    {"share", need.limit_V > 0.0 ? nlohmann::json(need.share()) : nlohmann::json(nullptr)},
                    {"time_s", need.time_s},
                    {"line", need.line},
                    {"position_mm", need.position_mm},
                    {"speed_mm_s", need.speed_mm_s},
                    {"acceleration_mm_s2", need.acceleration_mm_s2}});
  return list;
}

}  // namespace host
