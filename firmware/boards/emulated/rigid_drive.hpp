// The paper's drive on the emulated board: one mass, viscous and Coulomb friction, an encoder, a tachometer with noise.
#pragma once

#include <cmath>
#include <cstdint>

namespace firmware::boards {

/// Values of tests/data/drive-cases/none/case-00/model.toml; converters as in the host's simulated board.
class RigidDrive {
 public:
  /// With the D/A converter at `code`; without current if it is not enabled.
  void advance(float duration_s, std::int32_t code, bool is_enabled) {
    constexpr int kParts = 4;
    const float part_s = duration_s / kParts;
    const std::int32_t acting = is_late_ ? earlier_code_ : code;
    earlier_code_ = code;
    const float effort = is_enabled ? kEffort * static_cast<float>(acting) / times_ : 0.0F;  // Nm, of a drive like x
    for (int part = 0; part < kParts; ++part) {
      const float before = speed_;
      move(effort, part_s);
      const float counts = 0.5F * (before + speed_) * part_s * kCountsPerRad;
      position_ += static_cast<std::int64_t>(counts * 4294967296.0F);
    }
  }

  /// From now on a drive with twice the inertia and friction, whose amplifier acts a control period later.
  void become_heavy_and_late() {
    times_ = 2.0F;
    is_late_ = true;
  }

  std::uint32_t counts() const { return static_cast<std::uint32_t>(position_ >> 32); }
  std::int32_t tachometer_code() {
    // The sum of four uniform random numbers is nearly normal; its standard deviation is 1 / sqrt(3).
    float sum = -2.0F;
    for (int i = 0; i < 4; ++i) {
      noise_ = noise_ * 1664525u + 1013904223u;
      sum += static_cast<float>(noise_ >> 8) * 0x1p-24F;
    }
    return static_cast<std::int32_t>(std::lrint((speed_ + kTachometerNoise * 1.7320508F * sum) * 64.0F));
  }

 private:
  static constexpr float kEffort = 6.4898F * 0.4769F * 0.00030517578125F;  ///< Nm a code
  static constexpr float kInertia = 0.010037F, kViscous = 0.0358409F;      ///< kg m^2, Nm s/rad
  static constexpr float kForward = 1.976F, kBackward = 1.62952F;          ///< Coulomb friction, Nm
  static constexpr float kCountsPerRad = 1.5915494F / 0.00244140625F;
  static constexpr float kTachometerNoise = 0.08888194F;  ///< rad/s

  /// From rest it breaks away if the effort exceeds the friction; if it comes to rest within a part, it stays at rest.
  void move(float effort, float part_s) {
    const bool is_forward = speed_ > 0.0F || (speed_ == 0.0F && effort > 0.0F);
    const float friction = is_forward ? kForward : kBackward;
    if (speed_ == 0.0F && std::fabs(effort) <= friction) return;
    const float net = effort - (is_forward ? friction : -friction);
    const float middle = speed_ + 0.5F * part_s / kInertia * (net - kViscous * speed_);
    const float next = speed_ + part_s / kInertia * (net - kViscous * middle);
    speed_ = speed_ != 0.0F && (next > 0.0F) != is_forward ? 0.0F : next;
  }

  float times_ = 1.0F;  ///< inertia and friction, relative to the constants
  bool is_late_ = false;
  std::int32_t earlier_code_ = 0;
  float speed_ = 0.0F;         ///< rad/s
  std::int64_t position_ = 0;  ///< 2^-32 counts
  std::uint32_t noise_ = 1;
};

}  // namespace firmware::boards
