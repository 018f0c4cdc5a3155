#include "host/scoreboard/simulated_null.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/identify/paper_drives.hpp"
#include "sim/plant.hpp"

namespace host {

namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Changes every parameter at random by up to `most`, relative.
void change(sim::DriveDescription& drive, Random& random, double most) {
  for (sim::EffectEntry& entry : drive.effects)
    for (auto& [id, value] : entry.parameters) value *= 1.0 + between(random, -most, most);
}

/// The command of a motion, sample by sample.
class Motion {
 public:
  Motion(const sim::DriveDescription& drive, bool closed_loop, Random& random)
      : closed_loop_(closed_loop), random_(random), period_s_(drive.data.sample_period_s) {
    const sim::EffectEntry& coulomb = *drive.find("coulomb");
    friction_V_ = coulomb.either("positive", "level") / drive.data.effort_per_volt();
    const double inertia_V = drive.find("inertia")->at("J") / drive.data.effort_per_volt();
    constexpr double kBandwidth_Hz = 6.0;
    gain_V_ = inertia_V * 2.0 * 3.141592653589793 * kBandwidth_Hz;
    top_speed_ = between(random, 20.0, 80.0);
  }

  double command(double speed) {
    if (left_s_ <= 0.0) next();
    left_s_ -= period_s_;
    if (!closed_loop_) return target_;
    const double step = acceleration_ * period_s_;
    reference_ += std::clamp(target_ - reference_, -step, step);
    const double sign = reference_ > 0.0 ? 1.0 : reference_ < 0.0 ? -1.0 : 0.0;
    return gain_V_ * (reference_ - speed) + sign * friction_V_;
  }

 private:
  /// Steps of the command above friction, or jogs with rests between; both go back and forth.
  void next() {
    direction_ = -direction_;
    if (closed_loop_) {
      const bool rests = between(random_, 0.0, 1.0) < 0.25;
      left_s_ = between(random_, 0.3, 1.2);
      target_ = rests ? 0.0 : direction_ * top_speed_ * std::pow(10.0, between(random_, -1.5, 0.0));
      acceleration_ = between(random_, 100.0, 1000.0);
      return;
    }
    left_s_ = between(random_, 0.1, 0.5);
    target_ = direction_ * friction_V_ * between(random_, 1.3, 2.5);
  }

  bool closed_loop_;
  Random& random_;
  double period_s_, friction_V_ = 0.0, gain_V_ = 0.0, top_speed_ = 0.0;
  double left_s_ = 0.0, target_ = 0.0, reference_ = 0.0, acceleration_ = 0.0, direction_ = -1.0;
};

Record record_of(const sim::DriveDescription& drive, const std::string& name, Random& random) {
  sim::Plant plant(drive, random());
  Motion motion(drive, between(random, 0.0, 1.0) < 0.6, random);
  Record record;
  record.path = name;
  record.columns = {"t_s", "u_V", "x_mm", "w_rad_s"};
  record.sample_period_s = drive.data.sample_period_s;
  const auto samples = static_cast<std::size_t>(between(random, 3.0, 10.0) / record.sample_period_s);
  for (std::size_t k = 0; k < samples; ++k) {
    const double speed = plant.read_tachometer().value_or(0.0);
    record.t_s.push_back(static_cast<double>(k) * record.sample_period_s);
    record.x.push_back(static_cast<double>(plant.encoder_counts()) * drive.data.encoder_resolution);
    record.w.push_back(speed);
    plant.set_command(motion.command(speed));
    record.u_V.push_back(plant.command_V());
    plant.advance(record.sample_period_s);
  }
  return record;
}

}  // namespace

SimulatedNull simulated_null(std::uint64_t seed) {
  Random random(seed);
  sim::DriveDescription drive = *paper_drive(between(random, 0.0, 1.0) < 0.5 ? "x" : "y");
  change(drive, random, 0.3);
  if (between(random, 0.0, 1.0) < 0.5)
    std::erase_if(drive.effects, [](const sim::EffectEntry& entry) { return entry.kind == "stribeck"; });
  SimulatedNull result;
  const auto count = static_cast<int>(between(random, 1.0, 4.0));
  for (int k = 0; k < count; ++k)
    result.train.push_back(record_of(drive, fmt::format("null-{}-train-{}", seed, k), random));
  if (between(random, 0.0, 1.0) < 0.5)
    result.validate.push_back(record_of(drive, fmt::format("null-{}-validate", seed), random));
  result.model = drive;
  change(result.model, random, 0.1);
  return result;
}

}  // namespace host
