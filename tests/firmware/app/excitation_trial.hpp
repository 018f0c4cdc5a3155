// A random drive on a board without parameters, a random excitation in a random box, and a random defect.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>

#include "firmware/app/board_application.hpp"
#include "hal/pc/faulty_axis.hpp"
#include "hal/pc/simulated_flash.hpp"
#include "hal/pc/simulated_panel.hpp"
#include "hal/pc/simulated_usb.hpp"
#include "tests/firmware/app/paper_values.hpp"

namespace firmware_test {

/// The board's side of one axis whose wires can be broken.
class FaultyBoard {
 public:
  static constexpr std::size_t kAxes = 1;
  using AxisType = hal::pc::FaultyAxis;
  struct ControlShutOut {
    ControlShutOut() {}  // NOLINT(modernize-use-equals-default): a guard that does nothing would be an unused variable
  };

  FaultyBoard(const sim::DriveDescription& drive, std::uint64_t seed) : plant_(drive, seed), axis_(plant_, {}, seed) {}

  hal::pc::FaultyAxis& axis(std::size_t) { return axis_; }
  hal::pc::SimulatedEmergencyStop& emergency_stop() { return stop_; }
  hal::pc::SimulatedSupply& supply() { return supply_; }
  hal::pc::SimulatedClock& clock() { return clock_; }
  hal::pc::SimulatedUsb& usb() { return usb_; }
  hal::pc::SimulatedFlash& parameter_flash() { return flash_; }
  void set_control_rate(std::uint32_t rate_Hz) { period_us_ = 1'000'000 / rate_Hz; }
  void begin_stall() {}
  void end_stall() {}
  void restart() {}

  sim::Plant& plant() { return plant_; }
  void advance() {
    axis_.advance(1e-6 * period_us_);
    clock_.advance_us(period_us_);
  }

 private:
  sim::Plant plant_;
  hal::pc::FaultyAxis axis_;
  hal::pc::SimulatedEmergencyStop stop_;
  hal::pc::SimulatedSupply supply_;
  hal::pc::SimulatedClock clock_;
  hal::pc::SimulatedUsb usb_{16};
  hal::pc::SimulatedFlash flash_{2, 4096, 4};
  std::uint32_t period_us_ = 1000;
};

enum class TrialFault {
  none,
  encoder_dead,
  encoder_reported_bad,
  encoder_swapped,
  tachometer_dead,
  tachometer_reversed,
  drive_faulted,
  emergency_stop,
  host_silent,
  dac_unhealthy,
  blocked,
  end_switch,
  asked
};
inline constexpr int kTrialFaults = 13;

class ExcitationTrial {
 public:
  explicit ExcitationTrial(std::uint64_t seed) : seed_(seed), random_(seed) {
    make_drive();
    make_excitation();
    fault_ = static_cast<TrialFault>(between(0, 2) == 0 ? 0 : between(0, kTrialFaults - 1));
    breaks_at_ = between(100, 2500);
  }

  void run() {
    FaultyBoard board(drive_, seed_);
    board.axis(0).defects.motor_reversed = is_reversed_;
    firmware::BoardApplication<float, FaultyBoard> application(board);
    application.start();
    for (int k = 0; k < 20; ++k) period(application, board);
    application.staged() = application.active();
    set(application.staged(), "x.unfitted.volts", 20.0);
    set(application.staged(), "x.unfitted.counts", firmware::kMostBoxCounts);
    firmware::RefusedValuePayload refused;
    accepted_ = application.commit(refused) == firmware::Status::ok &&
                application.load_excitation(levels_, 1) == firmware::Status::ok &&
                application.excite(request_, refused) == firmware::Status::ok;
    application.become_owner(1);
    const int most = static_cast<int>(request_.samples) + 20'000;
    for (int k = 0; k < most && application.any_enabled(); ++k) {
      if (k == breaks_at_) inject(application, board);
      if (k % 20 == 0 && !(fault_ == TrialFault::host_silent && k >= breaks_at_)) application.owner_heard(1);
      period(application, board);
      note(board);
    }
    state_ = application.excitation_state();
    axis_fault_ = static_cast<int>(application.axes()[0].fault());
    for (int k = 0; k < 2000; ++k) {
      period(application, board);
      note(board);
    }
    is_on_ = board.axis(0).drive_enable().is_on();
    final_speed_ = std::abs(board.plant().truth().w) * drive_.data.lead;
  }

  bool is_over() const {
    return accepted_ && state_.phase == static_cast<std::uint8_t>(firmware::ExcitationPhase::done);
  }
  firmware::ExcitationEnd end() const { return static_cast<firmware::ExcitationEnd>(state_.end); }
  bool is_on() const { return is_on_; }
  double final_speed() const { return final_speed_; }
  /// Speed of the last creep against friction in the simulation.
  double standing_speed() const {
    return 0.01 * static_cast<double>(request_.speed) * drive_.data.encoder_resolution * 1000.0;
  }
  bool is_blind() const {
    return !drive_.data.tach_noise_variance &&
           (fault_ == TrialFault::encoder_dead || fault_ == TrialFault::encoder_swapped);
  }

  double farthest() const { return farthest_; }
  double window() const { return request_.travel_counts * drive_.data.encoder_resolution; }
  double fastest() const { return fastest_; }

  /// Stopping distance from the speed at the edge of the window (or at the fault that removed the motor's torque):
  /// eight samples until the board acts, then braking by friction and, if the motor still works, half of the command's
  /// effort. Below two counts in four samples the encoder shows no speed that could be braked, so the axis coasts.
  double way_of_stop() const {
    const double v = std::max(crossing_speed_, 1e-12);
    const double unseen = std::min(v, 2.0 * drive_.data.encoder_resolution / 0.004);
    const double coasting = least_friction_ / inertia_ * drive_.data.lead;
    return v * v / (2.0 * deceleration()) + unseen * unseen / (2.0 * coasting) + v * kSamples * 0.001 +
           2.0 * drive_.data.encoder_resolution + blind_samples() * 0.001 * box_speed() +
           (fault_ == TrialFault::encoder_dead || fault_ == TrialFault::encoder_swapped ? 1.2 * window() / 8.0 : 0.0);
  }
  /// The encoder's speed is four samples old; a broken sensor is found some samples later.
  double fastest_allowed() const {
    return box_speed() + drive_.data.encoder_resolution / 0.004 * 2.0 +
           (full_acceleration() * (kSamples + blind_samples())) * 0.001;
  }

  std::string describe() const {
    return "seed " + std::to_string(seed_) + ": fault " + std::to_string(static_cast<int>(fault_)) + " at " +
           std::to_string(breaks_at_) + ", kind " + std::to_string(request_.kind) + ", ended " +
           std::to_string(state_.end) + ", axis fault " + std::to_string(axis_fault_) + ", window " +
           std::to_string(window()) + ", farthest " + std::to_string(farthest_) + ", way of stop " +
           std::to_string(way_of_stop()) + ", box speed " + std::to_string(box_speed()) + ", fastest " +
           std::to_string(fastest_) + ", allowed " + std::to_string(fastest_allowed()) +
           (is_reversed_ ? ", reversed" : "") + (drive_.data.tach_noise_variance ? ", tachometer" : "");
  }

 private:
  static constexpr double kSamples = 8.0;

  int between(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  double between(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
  double spread(double least, double most) { return least * std::pow(most / least, between(0.0, 1.0)); }

  /// Accelerations of 0.2 to 20 m/s^2 at the box's volts, friction of a tenth to a half of that command.
  void make_drive() {
    sim::DataSheet& data = drive_.data;
    const bool is_linear = between(0, 3) == 0;
    data.kind = is_linear ? sim::DriveKind::linear : sim::DriveKind::rotary;
    const double effort_per_volt = spread(0.2, 20.0);
    data.amplifier_gain_A_per_V = data.force_constant_N_per_V = effort_per_volt;
    data.torque_constant_Nm_per_A = 1.0;
    data.lead = is_linear ? 1.0 : spread(0.3, 5.0);
    const double unit = is_linear ? 0.001 : 1.0;  // of a millimetre
    data.encoder_resolution = unit * spread(0.0005, 0.01);
    data.dac_resolution_V = 20.0 / 65536.0;
    volts_ = spread(1.0, 9.0);
    full_acceleration_ = unit * spread(200.0, 20'000.0);
    inertia_ = effort_per_volt * volts_ * data.lead / full_acceleration_;
    const double share = between(0.1, 0.5);
    friction_ = share * effort_per_volt * volts_;
    const double other = friction_ * between(0.6, 1.0);
    const double viscous = friction_ * between(0.0, 0.2) / (full_acceleration_ / data.lead * 0.05);
    // Within the converter of the simulated tachometer: 512 rad/s, in steps of 1/64.
    const double highest = 0.2 * full_acceleration_ / data.lead;
    if (between(0, 1) == 0 && !is_linear && highest < 400.0 && highest > 10.0)
      data.tach_noise_variance = std::pow(0.0005 * highest, 2.0);
    drive_.effects = {{"inertia", {{"J", inertia_}}, {}, {}},
                      {"viscous", {{"B", viscous}}, {}, {}},
                      {"coulomb", {{"positive", friction_}, {"negative", -other}}, {}, {}}};
    least_friction_ = other;
    is_reversed_ = between(0, 1) == 0;
  }

  /// Suitable boxes: the distance to reach the box's speed is a part of the window.
  void make_excitation() {
    const sim::DataSheet& data = drive_.data;
    const double speed = full_acceleration_ * spread(0.01, 0.1);
    const double way = speed * speed / (2.0 * full_acceleration_);
    const double window = way * spread(2.0, 40.0);
    request_.travel_counts = static_cast<std::int32_t>(std::max(20.0, window / data.encoder_resolution));
    request_.speed = static_cast<float>(std::max(4.0, speed / data.encoder_resolution * 0.001));
    request_.drive_velocity = data.tach_noise_variance ? static_cast<float>(box_speed() / data.lead) : -1.0F;
    const double codes = volts_ / data.dac_resolution_V;
    request_.volts = static_cast<float>(codes);
    request_.samples = static_cast<std::uint32_t>(between(1000, 4000));
    request_.amplitude = static_cast<float>(codes * between(0.6, 1.0));
    const std::array kinds{firmware::ExcitationKind::train, firmware::ExcitationKind::train,
                           firmware::ExcitationKind::ramp, firmware::ExcitationKind::chirp};
    request_.kind = static_cast<std::uint8_t>(kinds.at(static_cast<std::size_t>(between(0, 3))));
    request_.period = static_cast<std::uint32_t>(between(100, 2000));
    request_.step = static_cast<std::uint32_t>(between(1, 20)) * 4294967u;
    request_.last_step = static_cast<std::uint32_t>(between(1, 100)) * 4294967u;
    request_.fade_samples = 50;
    if (request_.kind != 0) return;
    levels_.count = request_.count = 4;
    for (std::size_t i = 0; i < 4; ++i)
      levels_.entry[i] = {request_.amplitude * (i % 2 == 0 ? 1.0F : -1.0F) * (i < 2 ? 1.0F : 0.8F),
                          static_cast<std::uint32_t>(between(50, 600)), 0};
  }

  template <typename Application>
  void inject(Application& application, FaultyBoard& board) {
    hal::pc::AxisDefects& defects = board.axis(0).defects;
    switch (fault_) {
      case TrialFault::none:
      case TrialFault::host_silent:
        return;
      case TrialFault::encoder_dead:
        defects.encoder_dead = true;
        return;
      case TrialFault::encoder_reported_bad:
        defects.encoder_reported_bad = true;
        return;
      case TrialFault::encoder_swapped:
        defects.encoder_swapped = true;
        return;
      case TrialFault::tachometer_dead:
        defects.tachometer_dead = true;
        return;
      case TrialFault::tachometer_reversed:
        defects.tachometer_reversed = true;
        return;
      case TrialFault::drive_faulted:
        defects.drive_faulted = true;
        return;
      case TrialFault::emergency_stop:
        board.emergency_stop().press();
        board.axis(0).set_powered(false);
        return;
      case TrialFault::dac_unhealthy:
        defects.dac_unhealthy = true;
        return;
      case TrialFault::blocked:
        defects.blocked = true;
        return;
      case TrialFault::end_switch:
        defects.positive_end_reached = true;
        return;
      case TrialFault::asked:
        application.stop_excitation();
        return;
    }
  }

  template <typename Application>
  void period(Application& application, FaultyBoard& board) {
    application.control_period();
    board.advance();
  }

  void note(FaultyBoard& board) {
    const double way = std::abs(board.plant().truth().x);
    const double speed = std::abs(board.plant().truth().w) * drive_.data.lead;
    if (way > window() && farthest_ <= window()) crossing_speed_ = speed;
    farthest_ = std::max(farthest_, way);
    fastest_ = std::max(fastest_, speed);
  }

  double box_speed() const { return static_cast<double>(request_.speed) * drive_.data.encoder_resolution * 1000.0; }
  double full_acceleration() const { return (drive_.data.effort_per_volt() * volts_) / inertia_ * drive_.data.lead; }
  bool keeps_motor() const {
    return fault_ == TrialFault::none || fault_ == TrialFault::asked || fault_ == TrialFault::host_silent ||
           fault_ == TrialFault::end_switch || fault_ == TrialFault::blocked;
  }
  double deceleration() const {
    const double brake = keeps_motor() && axis_fault_ == 0
                             ? 0.5 * drive_.data.effort_per_volt() * static_cast<double>(request_.amplitude) *
                                   drive_.data.dac_resolution_V
                             : 0.0;
    return (least_friction_ + brake) / inertia_ * drive_.data.lead;
  }
  /// Delay of the filter over the difference of encoder and tachometer.
  double blind_samples() const {
    const bool is_sensor = fault_ == TrialFault::encoder_dead || fault_ == TrialFault::encoder_swapped ||
                           fault_ == TrialFault::tachometer_dead || fault_ == TrialFault::tachometer_reversed;
    return is_sensor ? 40.0 : 0.0;
  }

  std::uint64_t seed_;
  std::mt19937_64 random_;
  sim::DriveDescription drive_;
  double volts_ = 0.0, full_acceleration_ = 0.0, inertia_ = 0.0, friction_ = 0.0, least_friction_ = 0.0;
  bool is_reversed_ = false;
  firmware::ExcitationRequest request_;
  firmware::ExcitationEntriesRequest levels_;
  TrialFault fault_ = TrialFault::none;
  int breaks_at_ = 0;
  bool accepted_ = false, is_on_ = false;
  firmware::ExcitationStatePayload state_{};
  int axis_fault_ = 0;
  double farthest_ = 0.0, fastest_ = 0.0, crossing_speed_ = 0.0, final_speed_ = 0.0;
};

}  // namespace firmware_test
