// The machine's side of the board's connectors: a drive behind a D/A converter, an encoder and a tachometer.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>

#include "sim/drive.hpp"
#include "sim/foreign_motion.hpp"

namespace sim {

class Plant {
 public:
  /// Standing at travel 0, amplifier enabled, D/A converter at 0 V. `seed` fixes the tachometer's noise.
  /// Throws std::invalid_argument for a description that the catalogue cannot build.
  Plant(const DriveDescription& description, std::uint64_t seed);

  /// From now on `motion` replaces the drive and the tachometer's noise; data sheet, converter and encoder stay.
  /// Positions are rounded to counts. The true motion is then the motion at the encoder.
  void hand_over(std::shared_ptr<ForeignMotion> motion);

  /// Sets the D/A converter, volts: limited to its range, rounded to its resolution, held until the next call.
  void set_command(double u_V);

  /// Sets or drops the amplifier's enable: without it the motor has no current.
  void set_enabled(bool enabled);

  /// Advances the machine. Internal steps are at most 0.25 ms, so that the error of one step stays far below an encoder
  /// count at any acceleration that a drive reaches.
  void advance(double duration_s);

  /// Encoder position, counts from the start, rounded down to the last edge like a quadrature counter.
  std::int64_t encoder_counts() const { return counts_at(encoder_travel()); }
  /// The encoder's position before rounding, mm or m, and its counts.
  double encoder_travel() const { return foreign_ ? state_.x : drive_.encoder(state_); }
  std::int64_t counts_at(double encoder_travel) const;

  /// Reading of the scale on the table, mm or m, rounded to its resolution; empty for a drive without one, and if a
  /// foreign motion replaces the drive.
  std::optional<double> read_load_encoder() const;

  /// A tachometer reading, rad/s or m/s, with fresh noise; empty for a drive without one.
  std::optional<double> read_tachometer();

  double time_s() const { return time_s_; }
  double command_V() const { return command_V_; }
  const DataSheet& data() const { return data_; }

  /// The true motion, for comparison with the sensors.
  const DriveState& truth() const { return state_; }
  DriveState& truth() { return state_; }
  /// True travel of the table, which may be a mass of its own behind a spring or a gap.
  double table_travel() const { return drive_.has_second_mass() ? state_.load_x : state_.x; }

 private:
  void tell_foreign();
  void follow_foreign(double duration_s);

  DataSheet data_;
  std::shared_ptr<ForeignMotion> foreign_;
  Drive drive_;
  Drive unpowered_;  ///< the same without the motor's torque or force
  DriveState state_;
  std::mt19937_64 noise_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  double tach_deviation_ = 0.0;
  double command_V_ = 0.0;
  double time_s_ = 0.0;
  bool enabled_ = true;
};

}  // namespace sim
