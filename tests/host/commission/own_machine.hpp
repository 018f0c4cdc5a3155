// A machine independent of the simulator, connected to the simulated board and its protocol.
#pragma once

#include <signal.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "host/commission/commission.hpp"
#include "host/exit_codes.hpp"
#include "host/simulated_board/simulated_link.hpp"

/// A mass with Coulomb friction on a screw, in Nm, kg m^2, rad/s and mm; optionally with cogging or a weight.
class OwnMachine : public sim::ForeignMotion {
 public:
  double inertia = 0.008, friction_Nm = 2.0;
  bool is_late = false;  ///< its amplifier acts one control period later
  bool counts_backward = false;
  double cogging_Nm = 0.0;  ///< amplitude, with a period of 4 mm
  double weight_Nm = 0.0;
  /// Process force against the axis by machine time, N at the table. Only the moving axis feels it: its screw is
  /// self-locking.
  std::function<double(double t_s)> process_N;
  double tachometer_deviation = 0.1;  ///< deviation of the speed's noise in motion, rad/s
  double resting_deviation = 0.0;     ///< the same of the axis at rest
  double seizes_at_s = HUGE_VAL;      ///< machine time at which its bearing seizes

  void command(std::optional<double> u_V) override { u_V_ = is_late ? std::exchange(next_V_, u_V) : u_V; }
  void advance(double duration_s) override {
    constexpr int kSteps = 20;
    for (int step = 0; step < kSteps; ++step) {
      lived_s_ += duration_s / kSteps;
      move(duration_s / kSteps);
    }
  }
  sim::ForeignReading reading() const override {
    return {counts_backward ? -x_ : x_, noisy_ + (counts_backward ? -w_ : w_)};
  }

  double position() const { return x_; }
  void seed(std::uint32_t seed) { random_.seed(seed); }  ///< of the speed's noise

 private:
  void move(double dt) {
    constexpr double kEffort = 3.0, kLead = 1.6;
    const double magnets = cogging_Nm * std::sin(2.0 * std::numbers::pi * x_ / 4.0);
    const double process_Nm = process_N && w_ != 0.0 ? 1e-3 * kLead * process_N(lived_s_) : 0.0;
    const double drive = kEffort * u_V_.value_or(0.0) + magnets - weight_Nm - process_Nm;
    const bool is_seized = lived_s_ > seizes_at_s;
    if (is_seized) w_ = 0.0;
    if (is_seized || (w_ == 0.0 && std::abs(drive) <= friction_Nm)) {
      if (resting_deviation > 0.0) noisy_ = resting_deviation * normal_(random_);
      return;
    }
    const double way = w_ != 0.0 ? std::copysign(1.0, w_) : std::copysign(1.0, drive);
    const double w = w_ + dt / inertia * (drive - 0.03 * w_ - friction_Nm * way);
    x_ += kLead * dt * (w_ + w) / 2.0;
    w_ = w_ * w < 0.0 ? 0.0 : w;
    noisy_ = tachometer_deviation * normal_(random_);
  }

  std::optional<double> u_V_, next_V_;
  double x_ = 0.0, w_ = 0.0, noisy_ = 0.0, lived_s_ = 0.0;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

/// Its data sheet, with an error of 5 %.
inline sim::DriveDescription own_sheet() {
  sim::DataSheet data;
  data.amplifier_gain_A_per_V = 6.3;
  data.torque_constant_Nm_per_A = 0.5;
  data.lead = 1.6;
  data.dac_resolution_V = 20.0 / 65536.0;
  data.encoder_resolution = 0.001;
  data.tach_noise_variance = 0.01;
  return {"own", data, {}};
}

/// A board that remains when its program ends; its link may break after a number of reports.
struct OwnBoard {
  std::shared_ptr<OwnMachine> machine = std::make_shared<OwnMachine>();
  std::shared_ptr<host::SimulatedLink> link;
  long reports_left = -1;  ///< negative: the link does not break
  bool dies_then = false;  ///< then kills the whole program

  /// Wiring with the home switch that own_options() use.
  static hal::pc::AxisWiring usual_wiring() {
    hal::pc::AxisWiring wiring;
    wiring.home = 11.3;
    return wiring;
  }

  explicit OwnBoard(const hal::pc::AxisWiring& wiring = usual_wiring()) {
    sim::DriveDescription hollow = own_sheet();
    hollow.effects.push_back({"inertia", {{"J", 1.0}}, {}, {}});
    link = std::make_shared<host::SimulatedLink>(host::SimulatedDeviceOptions{{{hollow, wiring, machine}}, "", 1});
  }

  class Way : public host::ReportLink {
   public:
    explicit Way(OwnBoard& board) : board_(board) {}
    void send(const hal::HidReport& report) override {
      if (board_.reports_left == 0 && board_.dies_then) ::raise(SIGKILL);
      if (board_.reports_left == 0) throw host::Failure(host::ExitCode::no_such_device, "the board is gone");
      if (board_.reports_left > 0) --board_.reports_left;
      board_.link->send(report);
    }
    std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override {
      return board_.link->receive(limit);
    }
    std::chrono::steady_clock::time_point now() const override { return board_.link->now(); }
    void wait(std::chrono::milliseconds duration) override { board_.link->wait(duration); }
    std::string name() const override { return "own"; }

   private:
    OwnBoard& board_;
  };

  host::BoardClient client() { return host::BoardClient(std::make_unique<Way>(*this)); }
};

inline host::CommissionOptions own_options() {
  host::CommissionOptions options;
  options.axis_name = "x";
  options.sheet = own_sheet();
  options.box = {80.0, 150.0, 4.0, 600.0};
  options.homing = host::CommissionHoming{firmware::HomingMode::home_switch, 0.0};
  return options;
}

/// Runs steps by name. Returns exit code and message of the failure, or done.
inline std::pair<host::ExitCode, std::string> commission(OwnBoard& board, const std::string& folder_name,
                                                         const char* from, const char* to,
                                                         const host::CommissionTalk& talk = {},
                                                         const host::CommissionOptions& options = own_options()) {
  try {
    host::CommissionFolder folder(folder_name);
    host::BoardClient client = board.client();
    host::commission_axis(client, options, talk, folder, host::commission_step(from), host::commission_step(to));
    return {host::ExitCode::done, ""};
  } catch (const host::Failure& failure) {
    return {failure.code, failure.what()};
  }
}
