// One axis of the simulated board: the board's side of the connectors, wired to a simulated drive.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "hal/axis_hal.hpp"
#include "hal/limit_inputs.hpp"
#include "hal/pc/simulated_brake.hpp"
#include "sim/plant.hpp"

namespace hal::pc {

/// Further hardware that is connected to the board.
struct AxisWiring {
  /// Tachometer A/D converter, rad/s (m/s) a code: 16 bits over -512..+512 rad/s. A code is far below the paper's noise
  /// of 0.22 rad/s, so it does not change the model's noise variance.
  double tachometer_resolution = 1.0 / 64.0;
  double negative_end = -std::numeric_limits<double>::infinity();  ///< travel at which the switch acts, mm (m)
  double positive_end = std::numeric_limits<double>::infinity();
  double home = std::numeric_limits<double>::quiet_NaN();  ///< home switch: actuated at and beyond it; NaN: none
  double index_spacing = 0.0;  ///< travel from one index pulse to the next, mm (m); 0: none is wired
  double index_offset = 0.0;   ///< travel at which one of the pulses occurs
  double ready_after_s =
      0.0;  ///< of a FaultyAxis: time from the enable, at which it drives, until the amplifier reports ready
  BrakeWiring brake{};  ///< of a FaultyAxis
};

/// Satisfies AxisHal; limits() satisfies LimitInputs. The caller owns the plant and advances its time.
class SimulatedAxis {
 public:
  /// Removes the current from the drive, as a board does at reset. Throws std::invalid_argument for a drive without a
  /// resolution of converter or encoder: codes and counts are then undefined.
  explicit SimulatedAxis(sim::Plant& plant, const AxisWiring& wiring = {})
      : encoder_{plant, wiring},
        tachometer_{plant, wiring.tachometer_resolution},
        dac_{plant},
        enable_{plant},
        limits_{plant, wiring},
        table_{plant} {
    if (!(plant.data().dac_resolution_V > 0.0))
      throw std::invalid_argument(
          "the simulated board needs the D/A converter's resolution: set resolution_V under "
          "[drive.dac]");
    if (!(plant.data().encoder_resolution > 0.0))
      throw std::invalid_argument(
          "the simulated board needs the encoder's resolution: set resolution_mm (or "
          "resolution_m) under [drive.encoder]");
    enable_.set(false);
    dac_.write(0);
  }
  SimulatedAxis(const SimulatedAxis&) = delete;
  SimulatedAxis& operator=(const SimulatedAxis&) = delete;

  class SimulatedEncoder {
   public:
    SimulatedEncoder(sim::Plant& plant, const AxisWiring& wiring)
        : plant_(plant), wiring_(wiring), last_turn_(turn_of(plant.encoder_counts())) {}
    EncoderReading read() { return {static_cast<std::uint32_t>(plant_.encoder_counts()), true}; }
    bool is_faulted() const { return false; }

    /// The last of the pulses passed since the last call.
    IndexReading read_index() {
      if (!(wiring_.index_spacing > 0.0)) return {};
      const std::int64_t turn = turn_of(plant_.encoder_counts());
      const std::int64_t passed = turn - last_turn_;
      last_turn_ = turn;
      if (passed == 0) return {};
      const auto pulse = static_cast<double>(passed > 0 ? turn : turn + 1);
      const double travel = wiring_.index_offset + pulse * wiring_.index_spacing;
      const auto counts = std::llround(travel / plant_.data().encoder_resolution);
      return {static_cast<std::uint32_t>(counts), true, passed < -1 || passed > 1};
    }

    /// Tells that a probe's edge occurred at these counts.
    void latch(std::int64_t counts) { latched_ = {static_cast<std::uint32_t>(counts), true}; }
    EncoderReading read_latch() {
      const EncoderReading latched = latched_;
      latched_.valid = false;
      return latched;
    }

   private:
    std::int64_t turn_of(std::int64_t counts) const {
      if (!(wiring_.index_spacing > 0.0)) return 0;
      const double travel = static_cast<double>(counts) * plant_.data().encoder_resolution;
      return static_cast<std::int64_t>(std::floor((travel - wiring_.index_offset) / wiring_.index_spacing));
    }

    sim::Plant& plant_;
    AxisWiring wiring_;
    std::int64_t last_turn_;
    EncoderReading latched_{};
  };

  class SimulatedTachometer {
   public:
    SimulatedTachometer(sim::Plant& plant, double resolution) : plant_(plant), resolution_(resolution) {}

    /// Invalid for a drive without a tachometer, and beyond the converter's 16 bits.
    TachometerReading read() {
      const auto velocity = plant_.read_tachometer();
      if (!velocity) return {};
      const double code = std::round(*velocity / resolution_);
      if (!(std::abs(code) <= 32767.0)) return {};
      return {static_cast<std::int32_t>(code), true};
    }

   private:
    sim::Plant& plant_;
    double resolution_;
  };

  class SimulatedDac {
   public:
    explicit SimulatedDac(sim::Plant& plant) : plant_(plant) {}
    bool write(std::int32_t code) {
      plant_.set_command(code * plant_.data().dac_resolution_V);
      return true;
    }
    bool is_healthy() const { return true; }

   private:
    sim::Plant& plant_;
  };

  class SimulatedEnable {
   public:
    explicit SimulatedEnable(sim::Plant& plant) : plant_(plant) {}
    void set(bool on) {
      is_on_ = on;
      plant_.set_enabled(on);
    }
    bool is_ready() const { return is_on_; }
    void release_brake(bool released) { is_brake_released_ = released; }
    bool is_brake_released() const { return is_brake_released_; }
    bool is_faulted() { return false; }
    bool is_on() const { return is_on_; }

   private:
    sim::Plant& plant_;
    bool is_on_ = false;
    bool is_brake_released_ = false;
  };

  class SimulatedLimits {
   public:
    SimulatedLimits(sim::Plant& plant, const AxisWiring& wiring) : plant_(plant), wiring_(wiring) {}
    LimitState read() {
      const double travel = static_cast<double>(plant_.encoder_counts()) * plant_.data().encoder_resolution;
      return {.positive_end = travel >= wiring_.positive_end,
              .negative_end = travel <= wiring_.negative_end,
              .home = travel >= wiring_.home};
    }

   private:
    sim::Plant& plant_;
    AxisWiring wiring_;
  };

  /// The scale on the table; invalid for a drive without one.
  class SimulatedScale {
   public:
    explicit SimulatedScale(sim::Plant& plant) : plant_(plant) {}
    EncoderReading read() {
      const auto travel = plant_.read_load_encoder();
      if (!travel) return {};
      return {static_cast<std::uint32_t>(std::llround(*travel / plant_.data().load_encoder_resolution)), true};
    }

   private:
    sim::Plant& plant_;
  };

  SimulatedEncoder& encoder() { return encoder_; }
  SimulatedTachometer& tachometer() { return tachometer_; }
  SimulatedDac& dac() { return dac_; }
  SimulatedEnable& drive_enable() { return enable_; }
  SimulatedLimits& limits() { return limits_; }
  SimulatedScale& table_encoder() { return table_; }

 private:
  SimulatedEncoder encoder_;
  SimulatedTachometer tachometer_;
  SimulatedDac dac_;
  SimulatedEnable enable_;
  SimulatedLimits limits_;
  SimulatedScale table_;
};

static_assert(AxisHal<SimulatedAxis>);
static_assert(TableEncoderHal<SimulatedAxis>);
static_assert(LatchedEncoder<SimulatedAxis::SimulatedEncoder>);
static_assert(LimitInputs<SimulatedAxis::SimulatedLimits>);

}  // namespace hal::pc
