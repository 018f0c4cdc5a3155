// Image that measures how long the background's requests block the control interrupt while both axes move, and what its
// watches take.
#include <array>
#include <cstdint>
#include <utility>

#include "firmware/app/board_application.hpp"
#include "firmware/app/friction_watch.hpp"
#include "firmware/app/process_limit.hpp"
#include "firmware/boards/emulated/memory_flash.hpp"
#include "firmware/boards/image/board_scalar.hpp"
#include "firmware/boards/image/capture_memory.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "tests/firmware/fitted_axis.hpp"
#include "tests/target/images/instruction_counter.hpp"
#include "tests/target/images/rigid_drive.hpp"

namespace firmware::boards {
void make_outputs_safe() noexcept {}
}  // namespace firmware::boards

extern "C" void control_interrupt() {}

namespace {

using namespace target_image;
using firmware::Status;
using MemoryFlash = firmware::boards::MemoryFlashOf<12288>;  // two full tables of pitch errors fit
using firmware::boards::ValueAxis;

MemoryFlash::Cells flash_cells;

class CountedBoard {
 public:
  static constexpr std::size_t kAxes = hal::kAxisCount;
  using AxisType = ValueAxis;

  /// Records the instructions that are executed while the outermost object exists.
  class ControlShutOut {
   public:
    ControlShutOut() {
      if (depth++ == 0) began = instructions();
    }
    ~ControlShutOut() {
      if (--depth != 0) return;
      const std::uint32_t lasted = instructions() - began;
      if (lasted > longest) longest = lasted;
    }
    ControlShutOut(const ControlShutOut&) = delete;
    ControlShutOut& operator=(const ControlShutOut&) = delete;

    static inline std::uint32_t longest = 0;

   private:
    static inline std::uint32_t began = 0;
    static inline int depth = 0;
  };

  struct Stop {
    bool is_pressed() const { return false; }
  };
  struct Supply {
    bool is_low() const { return false; }
  };
  struct Clock {
    std::uint32_t us = 0;
    std::uint32_t now_us() const { return us; }
  };
  struct Usb {
    bool send(const hal::HidReport&) { return false; }
    bool receive(hal::HidReport&) { return false; }
    bool is_configured() const { return false; }
  };

  ValueAxis& axis(std::size_t index) { return axes_[index]; }
  Stop& emergency_stop() { return stop_; }
  Supply& supply() { return supply_; }
  Clock& clock() { return clock_; }
  Usb& usb() { return usb_; }
  MemoryFlash& parameter_flash() { return flash_; }
  firmware::TriggeredState& capture_state() { return firmware::boards::capture_state(); }
  std::span<std::uint16_t> capture_rows() { return firmware::boards::capture_rows(); }
  void set_control_rate(std::uint32_t) {}
  void begin_stall() {}
  void end_stall() {}
  void restart() {}

 private:
  std::array<ValueAxis, kAxes> axes_;
  Stop stop_;
  Supply supply_;
  Clock clock_;
  Usb usb_;
  MemoryFlash flash_{flash_cells};
};
static_assert(hal::Board<CountedBoard>);

CountedBoard board;
using Application = firmware::BoardApplication<firmware::boards::BoardScalar, CountedBoard>;
Application application(board);
std::array drives{RigidDrive{firmware_test::kPaperX}, RigidDrive{firmware_test::kPaperY}};

void run(int periods) {
  for (int period = 0; period < periods; ++period) {
    for (std::size_t axis = 0; axis < drives.size(); ++axis) drives[axis].bring_readings(board.axis(axis));
    board.clock().us += 1000;
    application.control_period();
  }
}

void expect(bool holds, int exit_code) {
  if (!holds) hal::qemu::exit_emulator(exit_code);
}

/// Longest time for which `request` disables the control interrupt; the axes keep running before and after it.
template <typename Request>
void report_shut_out(const char* name, Request request) {
  Cost cost;
  for (int trial = 0; trial < 100; ++trial) {
    CountedBoard::ControlShutOut::longest = 0;
    request(trial);
    cost.add(CountedBoard::ControlShutOut::longest);
    run(3);
    application.owner_heard(firmware::ClientToken{1});
  }
  expect(application.any_enabled() && application.axis_status(0).velocity != 0.0F, 4);
  report(name, cost);
}

/// The largest number of points, for each axis; no drive is enabled.
void load_tables() {
  for (std::uint16_t axis = 0; axis < CountedBoard::kAxes; ++axis) {
    auto& store = application.store();
    const std::uint32_t bits = firmware::resolution_bits(application.active(), axis);
    firmware::Crc32 crc;
    expect(store.begin_table(application.active().size(), axis, firmware::kMostPitchPoints, bits) ==
               firmware::SaveResult::saved,
           7);
    for (int i = 0; i < static_cast<int>(firmware::kMostPitchPoints); ++i) {
      const firmware::PitchPoint point{1000 * i, 100 * i, -70 * i};
      expect(store.add_point(point), 8);
      crc.add(std::as_bytes(std::span(&point, 1)));
    }
    expect(application.finish_table(crc.value(), true) == Status::ok, 9);
  }
}

/// The application as the watch of the process force sees it while both axes follow a path.
struct OnAPath {
  using Number = Application::Number;
  using BoardType = CountedBoard;
  static constexpr std::size_t kAxes = Application::kAxes;
  struct Path {
    bool is_moving() const { return true; }
    bool leads(std::size_t) const { return true; }
    void hold_for_process() const { hal::qemu::exit_emulator(10); }
  };

  const auto& active() const { return application.active(); }
  auto& axes() const { return application.axes(); }
  Path path() const { return {}; }
};

/// Both watches of the background, for both axes, once a control period.
void count_watches() {
  firmware::FrictionWatch<Application> friction;
  firmware::ProcessLimit<OnAPath> force;
  OnAPath on_a_path;
  Cost cost;
  for (int period = 0; period < 500; ++period) {
    run(1);
    cost.add(count([&] {
      force.poll(on_a_path);
      friction.poll(application);
    }));
    application.owner_heard(firmware::ClientToken{1});
  }
  report("watches", cost);
}

}  // namespace

extern "C" [[noreturn]] void run_board() {
  firmware::boards::arm_fault_detection();
  start_counting();
  application.start();
  application.staged() = application.active();
  firmware_test::fit_axis(application.staged(), "x", firmware_test::kPaperX);
  firmware_test::fit_axis(application.staged(), "y", firmware_test::kPaperY);
  const std::size_t timeout = firmware_test::find_place("", "host.timeout").value_or(0);
  const std::size_t standing = firmware_test::find_place("", "host.standing_timeout").value_or(0);
  application.staged().set(timeout, 10.0F);
  firmware::RefusedValuePayload refused;
  Cost commits, shut_out;
  const auto commit_all = [&] {
    CountedBoard::ControlShutOut::longest = 0;
    commits.add(count([&] { expect(application.commit(refused) == Status::ok, 1); }));
    shut_out.add(CountedBoard::ControlShutOut::longest);
    run(200);
  };
  expect(application.commit(refused) == Status::ok, 1);
  load_tables();
  application.staged() = application.active();
  // Everything that takes long is switched on: friction curves, filters, cogging, pitch. Then its values change.
  for (const float more : {0.0F, 1.0F, 2.0F}) {
    if (more > 0.0F) application.staged() = application.active();
    for (const char* axis : {"x", "y"}) {
      const auto put = [&](const char* name, float value) {
        application.staged().set(firmware_test::find_place(axis, name).value_or(0), value);
      };
      for (const char* name : {"notch.on", "low_pass.on", "cogging.on", "position_friction.on", "backlash.on"})
        put(name, 1.0F);
      put("notch.frequency", 400.0F + more);
      put("low_pass.frequency", 430.0F + more);
      put("backlash.gap", 0.01F);
      put("friction.omega1_positive", 2.0F + 0.1F * more);
    }
    commit_all();
  }
  application.staged() = application.active();
  for (const char* axis : {"x", "y"})
    for (const auto& [name, value] :
         {std::pair{"feedforward.friction", 1.0F}, std::pair{"feedforward.friction_watch", 1.0F},
          std::pair{"feedback.hold_effort", 1e3F}})
      application.staged().set(firmware_test::find_place(axis, name).value_or(0), value);
  expect(application.commit(refused) == Status::ok, 11);
  run(200);
  std::size_t refused_axis = 0;
  expect(application.enable(3, refused_axis) == Status::ok, 2);
  application.become_owner(firmware::ClientToken{1});
  run(500);
  for (std::size_t axis = 0; axis < drives.size(); ++axis) expect(application.jog(axis, 20.0F) == Status::ok, 3);
  run(200);

  count_watches();
  report_shut_out("parameter_change", [&](int trial) {
    application.staged() = application.active();
    application.staged().set(standing, trial % 2 == 0 ? 50.0F : 60.0F);
    expect(application.commit(refused) == Status::ok, 5);
  });
  report_shut_out("other_requests", [&](int trial) {
    for (std::size_t axis = 0; axis < drives.size(); ++axis) {
      expect(application.jog(axis, trial % 2 == 0 ? 25.0F : 15.0F) == Status::ok, 6);
      application.axis_status(axis);
      application.move(axis, 1000, true);  // refused: in motion
    }
    application.owner_heard(firmware::ClientToken{1});
    application.clear_faults();
    application.timing();
    application.trigger_state();
    application.excitation_state();
    application.start_capture({});
  });
  Cost states;
  for (int trial = 0; trial < 100; ++trial) {
    states.add(count([] {
      const firmware::AxisStatus status = application.axis_status(0);
      asm volatile("" ::"r"(&status) : "memory");  // all of it is needed
    }));
    run(1);
  }
  report("axis_status", states);
  report("commit_at_standstill", commits);
  report("commit_at_standstill_shut_out", shut_out);
  hal::qemu::exit_emulator(0);
}
