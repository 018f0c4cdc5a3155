#include "host/plan/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/drive.hpp"

namespace host {

namespace {

/// Makes pieces between the command that just moves the drive and the limit of the box.
class Pieces {
 public:
  Pieces(const sim::DriveDescription& model, const ExcitationLimits& box) : box_(box), data_(model.data) {
    const sim::Drive drive(model);
    for (const sim::FrictionSide& side : drive.friction)
      holding_V_ = std::max(holding_V_, std::max(side.coulomb, side.breakaway) / drive.effort_per_volt);
    const bool rotary = data_.kind == sim::DriveKind::rotary;
    millimetre_ = rotary ? 1.0 : 1e-3;
    turn_ = data_.turn();
    rate_Hz_ = 1.0 / data_.sample_period_s;
  }

  std::vector<RunPiece> all() {
    steps();
    coast_downs();
    ramps();
    sines();
    multisines();
    reversals();
    ladders();
    dwells();
    return std::move(list_);
  }

 private:
  /// Voltages that move the axis, at parts of the range between friction and the limit of the box.
  std::vector<double> voltages(std::initializer_list<double> shares) const {
    std::vector<double> values;
    for (const double share : shares) {
      const double value = holding_V_ + share * (box_.volts - holding_V_);
      if (value > holding_V_ && value <= box_.volts) values.push_back(value);
    }
    return values;
  }

  void add(const char* kind, std::vector<double> values, std::map<std::string, double> named, double time_s,
           const char* closed_loop = "") {
    if (time_s <= box_.time_s) list_.push_back({kind, {std::move(values), std::move(named)}, closed_loop, time_s});
  }

  void steps() {
    const std::vector<double> volts = voltages({1.0, 0.5, 0.2});
    for (const double u : volts)
      for (const double hold : {0.04, 0.12, 0.4}) add("steps", {u, -u}, {{"hold", hold}}, std::max(1.0, 6.0 * hold));
    // Two voltages, and several accelerations over about the same stroke.
    if (volts.size() < 2) return;
    for (const double hold : {0.08, 0.25})
      add("steps", {volts[0], -volts[0], volts.back(), -volts.back()}, {{"hold", hold}}, std::max(1.2, 8.0 * hold));
  }

  void coast_downs() {
    for (const double u : voltages({1.0, 0.4}))
      for (const double hold : {0.1, 0.3}) add("steps", {u, 0.0, -u, 0.0}, {{"hold", hold}}, 8.0 * hold);
  }

  /// Breakaways: the command ramps slowly through zero and through the static friction.
  void ramps() {
    const double most = std::min(box_.volts, 1.6 * holding_V_);
    for (const double time : {0.3, 1.0}) add("ramp", {}, {{"amplitude", most}, {"time", time}}, 4.0 * time);
  }

  void sines() {
    for (const double u : voltages({1.0, 0.4}))
      for (const double frequency : {2.0, 6.0, 20.0, 60.0})
        if (frequency < 0.1 * rate_Hz_)
          add("sine", {}, {{"amplitude", u}, {"frequency", frequency}}, std::max(1.0, 4.0 / frequency));
    for (const double ride : {0.05, 0.3})
      for (const double frequency : {1.0, 5.0}) {
        // The reference never reverses, because the jog is faster than the sine.
        const double speed = ride * box_.speed;
        const double amplitude = 0.8 * speed / (2.0 * std::numbers::pi * frequency);
        add("sine", {}, {{"amplitude", amplitude}, {"frequency", frequency}, {"ride", speed}}, 2.0, "reference");
      }
  }

  void multisines() {
    for (const double u : voltages({1.0, 0.4}))
      add("multisine", {}, {{"amplitude", u}, {"from", 4.0}, {"to", std::min(150.0, 0.2 * rate_Hz_)}}, 2.0);
    for (const double ride : {0.05, 0.3})
      add("multisine", {},
          {{"amplitude", 0.5 * box_.volts},
           {"from", 4.0},
           {"to", std::min(150.0, 0.2 * rate_Hz_)},
           {"ride", ride * box_.speed}},
          2.5, "output");
  }

  void reversals() {
    for (const double size : {0.01, 0.03, 0.1, 0.3}) {
      const double amplitude = size * millimetre_;
      if (amplitude < 2.0 * data_.encoder_resolution) continue;
      for (const double frequency : {1.0, 5.0})
        add("reversals", {}, {{"amplitude", amplitude}, {"speed", 4.0 * amplitude * frequency}}, 2.0);
    }
  }

  void ladders() {
    const double v = box_.speed;
    add("ladder", {0.02 * v, 0.1 * v, 0.4 * v}, {{"hold", 0.4}}, 2.6);
    add("ladder", {0.3 * v, 0.7 * v}, {{"hold", 0.3}}, 1.6);
    add("ladder", {0.003 * v, 0.01 * v}, {{"hold", 0.5}}, 2.2);
  }

  /// Rests of several durations, between jogs that end at several angles of a turn.
  void dwells() {
    const double speed = 0.1 * box_.speed;
    add("dwell", {0.02, 0.05, 0.1, 0.3}, {{"speed", speed}, {"hold", 0.1}}, 1.5);
    add("dwell", {0.05, 0.2, 0.8, 1.6}, {{"speed", speed}, {"hold", 0.1}}, 4.0);
    if (turn_ > 0.0)
      add("dwell", {0.05, 0.05, 0.05, 0.05}, {{"speed", speed}, {"hold", std::max(0.05, 0.3 * turn_ / speed)}}, 2.0);
  }

  const ExcitationLimits& box_;
  const sim::DataSheet& data_;
  double holding_V_ = 0.0;  ///< largest voltage at which the axis stands still
  double millimetre_ = 1.0, turn_ = 0.0, rate_Hz_ = 1000.0;
  std::vector<RunPiece> list_;
};

}  // namespace

std::vector<RunPiece> candidate_pieces(const sim::DriveDescription& model, const ExcitationLimits& box) {
  return Pieces(model, box).all();
}

}  // namespace host
