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

  /// From now on `motion` takes the place of the drive and of the tachometer's noise; data sheet, converter and encoder
  /// stay. Positions are rounded to counts. The true motion is then what the encoder sees.
  void hand_over(std::shared_ptr<ForeignMotion> motion);

  /// Sets the D/A converter, volts: limited to its range, rounded to its resolution, held until the next call.
  void set_command(double u_V);

  /// Opens or closes the amplifier's enable: without it the motor is free of current.
  void set_enabled(bool enabled);

  /// Lets the machine run. Internal steps are at most 0.25 ms, so that the error of one step stays far below an encoder
  /// count at any acceleration that a drive reaches.
  void advance(double duration_s);

  /// Encoder position, counts from the start: the edge that was passed last (rounding down), as a quadrature counter
  /// does.
  std::int64_t encoder_counts() const { return counts_at(encoder_travel()); }
  /// What the encoder's grid is laid over, mm or m, and the counts there.
  double encoder_travel() const { return foreign_ ? state_.x : drive_.encoder(state_); }
  std::int64_t counts_at(double encoder_travel) const;

  /// What the scale on the table reads, mm or m, on its own grid; empty for a drive without one, and where a foreign
  /// motion has taken the drive's place.
  std::optional<double> read_load_encoder() const;

  /// A tachometer reading, rad/s or m/s, with fresh noise; empty for a drive without one.
  std::optional<double> read_tachometer();

  double time_s() const { return time_s_; }
  double command_V() const { return command_V_; }
  const DataSheet& data() const { return data_; }

  /// The true motion, for comparison with what the sensors say.
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
  Drive unpowered_;  ///< the same without the motor's effort
  DriveState state_;
  std::mt19937_64 noise_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  double tach_deviation_ = 0.0;
  double command_V_ = 0.0;
  double time_s_ = 0.0;
  bool enabled_ = true;
};

}  // namespace sim
