// The simulated board with disturbances of real ones: noise spikes on every input, an encoder with a drifting scale.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "hal/pc/simulated_board.hpp"

namespace firmware_test {

/// Noise spikes last one or two control periods, and occur about every ten seconds on each line.
class Sparks {
 public:
  explicit Sparks(std::uint64_t seed) : random_(seed), until_(next()) {}
  /// Call it once per control period.
  bool read() {
    if (--until_ > 0) return false;
    if (until_ > 1 - length_) return true;
    length_ = 1 + static_cast<int>(random_() & 1u);
    until_ = next();
    return true;
  }

 private:
  int next() { return 10 + static_cast<int>(random_() % 20'000u); }
  std::minstd_rand random_;
  int until_;
  int length_ = 1;
};

/// A simulated axis behind bad wires. Its encoder has an index pulse every 4096 counts.
class NoisyAxis {
 public:
  static constexpr std::int64_t kSpacing = 4096;

  NoisyAxis(sim::Plant& plant, hal::pc::SimulatedAxis& sound, std::uint64_t seed)
      : encoder_{plant}, enable_{sound.drive_enable(), seed}, limits_{plant, seed + 10}, sound_(sound) {}

  class Encoder {
   public:
    explicit Encoder(sim::Plant& plant) : plant_(plant) {}
    hal::EncoderReading read() { return {static_cast<std::uint32_t>(counts()), true}; }
    hal::IndexReading read_index() {
      const std::int64_t turn = turn_of(counts()), passed = turn - turn_;
      turn_ = turn;
      if (passed == 0) return {};
      return {static_cast<std::uint32_t>((passed > 0 ? turn : turn + 1) * kSpacing), true, passed < -1 || passed > 1};
    }
    std::int64_t counts() const { return plant_.encoder_counts() + creep; }
    std::int64_t creep = 0;  ///< displacement of the scale relative to the machine, counts

   private:
    static std::int64_t turn_of(std::int64_t counts) {
      return (counts - (counts % kSpacing + kSpacing) % kSpacing) / kSpacing;
    }
    sim::Plant& plant_;
    std::int64_t turn_ = 0;
  };

  class Enable {
   public:
    Enable(hal::pc::SimulatedAxis::SimulatedEnable& sound, std::uint64_t seed)
        : sound_(sound), fault_(seed), unready_(seed + 1) {}
    void set(bool on) { sound_.set(on); }
    bool is_faulted() { return fault_.read(); }
    bool is_ready() { return sound_.is_on() && !unready_.read(); }
    void release_brake(bool released) { sound_.release_brake(released); }

   private:
    hal::pc::SimulatedAxis::SimulatedEnable& sound_;
    Sparks fault_, unready_;
  };

  class Limits {
   public:
    Limits(sim::Plant& plant, std::uint64_t seed)
        : plant_(plant), positive_(seed), negative_(seed + 1), home_(seed + 2) {}
    hal::LimitState read() {
      const double x_mm = plant_.truth().x;
      return {(x_mm > 140.0) != positive_.read(), (x_mm < -140.0) != negative_.read(), (x_mm > 25.0) != home_.read()};
    }

   private:
    sim::Plant& plant_;
    Sparks positive_, negative_, home_;
  };

  Encoder& encoder() { return encoder_; }
  auto& tachometer() { return sound_.tachometer(); }
  auto& dac() { return sound_.dac(); }
  Enable& drive_enable() { return enable_; }
  Limits& limits() { return limits_; }

 private:
  Encoder encoder_;
  Enable enable_;
  Limits limits_;
  hal::pc::SimulatedAxis& sound_;
};

/// Satisfies hal::Board.
class NoisyBoard : public hal::pc::SimulatedBoard {
 public:
  using AxisType = NoisyAxis;
  using Base = hal::pc::SimulatedBoard;

  NoisyBoard(const Drives& drives, std::uint64_t seed)
      : Base(drives, seed),
        axes_{NoisyAxis(plant(0), Base::axis(0), 100 * seed + 20), NoisyAxis(plant(1), Base::axis(1), 100 * seed + 50)},
        stop_(100 * seed + 90) {}

  NoisyAxis& axis(std::size_t index) { return axes_[index]; }

  struct Stop {
    explicit Stop(std::uint64_t seed) : sparks(seed) {}
    bool is_pressed() { return sparks.read(); }
    Sparks sparks;
  };
  Stop& emergency_stop() { return stop_; }

 private:
  std::array<NoisyAxis, kAxes> axes_;
  Stop stop_;
};
static_assert(hal::Board<NoisyBoard>);

}  // namespace firmware_test
