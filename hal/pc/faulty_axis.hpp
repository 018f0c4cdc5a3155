// One axis of the simulated board whose sensors, wires and converter can be broken at any sample.
#pragma once

#include <cstdint>
#include <random>

#include "hal/pc/simulated_axis.hpp"

namespace hal::pc {

/// Present defects. All may occur at once; zero and false mean no defect.
struct AxisDefects {
  bool encoder_dead = false;          ///< its wires are cut: the counter does not move; only its receivers detect it
  bool encoder_reported_bad = false;  ///< its readings are invalid
  bool encoder_fault_open = false;    ///< the wire of its receivers' fault output is open
  bool encoder_swapped = false;       ///< both channels are interchanged: it counts the other way
  std::int32_t encoder_noise = 0;     ///< counts, evenly spread over +-noise at every reading
  std::int32_t encoder_lost = 0;      ///< lost counts
  bool tachometer_dead = false;       ///< reads 0
  bool tachometer_reversed = false;
  std::int32_t tachometer_offset = 0;  ///< codes
  bool motor_reversed = false;         ///< its leads are swapped
  bool dac_stuck = false;              ///< stays at dac_stuck_code
  std::int32_t dac_stuck_code = 0;
  bool dac_unhealthy = false;    ///< its registers, read back, differ from their setting
  bool blocked = false;          ///< nothing moves
  bool drive_faulted = false;    ///< the amplifier gives no current, and reports it
  bool unready = false;          ///< the amplifier's ready contact or its wire is open
  bool ready_stuck = false;      ///< that contact is welded
  bool enable_open = false;      ///< the amplifier does not see its enable
  bool enable_stuck = false;     ///< the amplifier always sees an enable; only its power can be cut
  bool amplifier_stuck = false;  ///< the amplifier gives the current of amplifier_stuck_code, even without an enable
  std::int32_t amplifier_stuck_code = 0;
  bool brake_stuck = false;           ///< the brake does not release
  std::int32_t amplifier_offset = 0;  ///< codes that it adds to its command while it drives
  bool positive_end_reached = false;
  bool negative_end_reached = false;
};

/// Satisfies AxisHal, with limits(). Defects may change at any time.
class FaultyAxis {
 public:
  FaultyAxis(sim::Plant& plant, const AxisWiring& wiring, std::uint64_t seed)
      : plant_(plant), sound_(plant, wiring), brake_(plant, wiring.brake), wiring_(wiring), noise_(seed) {}
  FaultyAxis(const FaultyAxis&) = delete;
  FaultyAxis& operator=(const FaultyAxis&) = delete;

  AxisDefects defects;

  class Encoder {
   public:
    explicit Encoder(FaultyAxis& axis) : axis_(axis) {}
    EncoderReading read() {
      const AxisDefects& d = axis_.defects;
      if (d.encoder_reported_bad) return {};
      const std::int64_t truth = axis_.plant_.encoder_counts();
      const std::int64_t travel = d.encoder_dead ? 0 : (d.encoder_swapped ? last_truth_ - truth : truth - last_truth_);
      last_truth_ = truth;
      counted_ += travel;
      std::int64_t reading = counted_ - d.encoder_lost;
      if (d.encoder_noise != 0)
        reading += std::uniform_int_distribution<std::int32_t>(-d.encoder_noise, d.encoder_noise)(axis_.noise_);
      return {static_cast<std::uint32_t>(reading), true};
    }
    bool is_faulted() const { return axis_.defects.encoder_dead || axis_.defects.encoder_fault_open; }

   private:
    FaultyAxis& axis_;
    std::int64_t last_truth_ = 0;
    std::int64_t counted_ = 0;
  };

  class Tachometer {
   public:
    explicit Tachometer(FaultyAxis& axis) : axis_(axis) {}
    TachometerReading read() {
      TachometerReading reading = axis_.sound_.tachometer().read();
      if (axis_.defects.tachometer_dead) reading.code = 0;
      if (axis_.defects.tachometer_reversed) reading.code = -reading.code;
      reading.code += axis_.defects.tachometer_offset;
      return reading;
    }

   private:
    FaultyAxis& axis_;
  };

  class Dac {
   public:
    explicit Dac(FaultyAxis& axis) : axis_(axis) {}
    bool write(std::int32_t code) {
      commanded_ = code;
      const AxisDefects& d = axis_.defects;
      put_out_ =
          d.amplifier_stuck ? d.amplifier_stuck_code : (d.dac_stuck ? d.dac_stuck_code : code) + d.amplifier_offset;
      return axis_.sound_.dac().write(d.motor_reversed ? -put_out_ : put_out_);
    }
    bool is_healthy() const { return !axis_.defects.dac_unhealthy; }
    std::int32_t commanded() const { return commanded_; }
    /// The command on which the amplifier acts, codes.
    std::int32_t put_out() const { return put_out_; }

   private:
    FaultyAxis& axis_;
    std::int32_t commanded_ = 0, put_out_ = 0;
  };

  class Enable {
   public:
    explicit Enable(FaultyAxis& axis) : axis_(axis) {}
    void set(bool on) {
      is_on_ = on;
      apply();
    }
    bool is_faulted() { return axis_.defects.drive_faulted; }
    bool is_ready() const {
      if (axis_.defects.ready_stuck || axis_.defects.unready) return !axis_.defects.unready;
      return drives() && on_for_s_ >= axis_.wiring_.ready_after_s;
    }
    void release_brake(bool released) {
      is_brake_released_ = released;
      apply();
    }
    bool is_on() const { return is_on_; }
    /// Whether the amplifier gives current.
    bool drives() const {
      const AxisDefects& d = axis_.defects;
      const bool sees_enable = (is_on_ && !d.enable_open) || d.enable_stuck || d.amplifier_stuck;
      return sees_enable && axis_.is_powered_ && !d.drive_faulted;
    }
    /// The stop relay removes the current of the brake as well as the enable.
    void apply() {
      axis_.sound_.drive_enable().set(drives());
      axis_.brake_.set_released(is_brake_released_ && axis_.is_powered_ && !axis_.defects.brake_stuck);
    }
    void pass(double duration_s) { on_for_s_ = drives() ? on_for_s_ + duration_s : 0.0; }

   private:
    FaultyAxis& axis_;
    bool is_on_ = false, is_brake_released_ = false;
    double on_for_s_ = 0.0;
  };

  class Limits {
   public:
    explicit Limits(FaultyAxis& axis) : axis_(axis) {}
    LimitState read() {
      LimitState state = axis_.sound_.limits().read();
      state.positive_end = state.positive_end || axis_.defects.positive_end_reached;
      state.negative_end = state.negative_end || axis_.defects.negative_end_reached;
      return state;
    }

   private:
    FaultyAxis& axis_;
  };

  Encoder& encoder() { return encoder_; }
  Tachometer& tachometer() { return tachometer_; }
  Dac& dac() { return dac_; }
  Enable& drive_enable() { return enable_; }
  Limits& limits() { return limits_; }

  /// The amplifier drives because of its enable, or a current without an enable acts on the axis.
  bool is_driven() const { return enable_.drives() && (enable_.is_on() || dac_.put_out() != 0); }

  /// The amplifier's supply, or the stop relay's contact in its enable line.
  void set_powered(bool powered) {
    is_powered_ = powered;
    enable_.apply();
  }

  /// Advances the machine with its present defects.
  void advance(double duration_s) {
    enable_.apply();
    if (defects.dac_stuck || defects.amplifier_stuck || defects.amplifier_offset != 0) dac_.write(dac_.commanded());
    const double x = plant_.truth().x, w = plant_.truth().w;
    plant_.advance(duration_s);
    if (defects.blocked) block(x, w, duration_s);
    brake_.act(x, w, duration_s);
    enable_.pass(duration_s);
  }

 private:
  /// The axis slips for a few milliseconds, then stands.
  void block(double x, double w, double duration_s) {
    constexpr double kLeft = 0.6, kStanding = 0.01;  // share of the speed after a period; rad/s (m/s)
    const double slowed = std::abs(w) < kStanding ? 0.0 : kLeft * w;
    sim::DriveState& truth = plant_.truth();
    truth.w = truth.load_w = slowed;
    truth.x = truth.load_x = x + (w + slowed) / 2.0 * plant_.data().lead * duration_s;
  }

  sim::Plant& plant_;
  SimulatedAxis sound_;
  SimulatedBrake brake_;
  AxisWiring wiring_;
  std::mt19937_64 noise_;
  bool is_powered_ = true;
  Encoder encoder_{*this};
  Tachometer tachometer_{*this};
  Dac dac_{*this};
  Enable enable_{*this};
  Limits limits_{*this};
};

static_assert(AxisHal<FaultyAxis>);
static_assert(MonitoredEncoder<FaultyAxis::Encoder>);
static_assert(LimitInputs<FaultyAxis::Limits>);

}  // namespace hal::pc
