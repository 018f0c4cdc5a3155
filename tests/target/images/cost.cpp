// Image that counts the instructions of the control law: estimator and feedback alone, one axis, both axes.
#include <array>
#include <cstdint>

#include "firmware/app/triggered_capture.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/excitation/excitation_run.hpp"
#include "firmware/core/fixed_units.hpp"
#include "firmware/core/path/path_follower.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "hal/axis_count.hpp"
#include "tests/firmware/paper_axes.hpp"
#include "tests/target/images/instruction_counter.hpp"
#include "tests/target/images/rigid_drive.hpp"

namespace firmware::boards {
void make_outputs_safe() noexcept {}
}  // namespace firmware::boards

extern "C" void control_interrupt() {}

namespace {

using namespace target_image;
using firmware::boards::ValueAxis;
using Scalar = AXIS_COST_SCALAR;
using Axes = firmware::AxisGroup<Scalar, ValueAxis, hal::kAxisCount>;

template <typename T>
constexpr firmware::AxisParameters<T> in_scalar(const firmware_test::PaperAxis& axis) {
  if constexpr (std::is_floating_point_v<T>)
    return firmware_test::parameters_of<T>(axis);
  else
    return firmware::to_fixed(firmware_test::parameters_of<double>(axis));
}

constexpr firmware::AxisParameters<Scalar> with_everything_on(const firmware_test::PaperAxis& axis) {
  firmware::AxisParameters<Scalar> p = in_scalar<Scalar>(axis);
  p.monitors.index_spacing = 4096;
  p.friction_feedforward_on = p.zero_phase_feedforward_on = p.disturbance_cancellation_on = true;
  return p;
}

// Computed by the compiler: the image holds numbers, not the conversion.
constexpr std::array kParameters{with_everything_on(firmware_test::kPaperX),
                                 with_everything_on(firmware_test::kPaperY)};

std::array<ValueAxis, hal::kAxisCount> io;
[[gnu::section(".ccm")]] Axes axes(io);
std::array drives{RigidDrive{firmware_test::kPaperX}, RigidDrive{firmware_test::kPaperY}};
std::uint32_t now_us = 0;

template <std::size_t axis>
[[gnu::noinline]] void step_one() {
  axes[axis].step();
}
[[gnu::noinline]] void step_both() { axes.step({now_us += 1000, false, false, false}); }

struct EstimatorAndFeedback {
  firmware::KalmanEstimator<Scalar> estimator;
  firmware::AxisEstimate<Scalar> estimate{};
  Scalar Kc1{}, Kc2{}, u{};

  [[gnu::noinline]] void step(std::int64_t counts, Scalar velocity, Scalar reference) {
    estimator.update(estimate, u, counts, velocity);
    u = Kc1 * (reference - estimate.offset) - Kc2 * estimate.velocity;
  }
};

void count_estimator_and_feedback() {
  EstimatorAndFeedback loop;
  const auto& p = kParameters[0];
  loop.estimator.configure(p.drive, p.Kobs, p.encoder_resolution);
  loop.Kc1 = p.Kc[0];
  loop.Kc2 = p.Kc[1];
  Cost cost;
  for (int k = 0; k < 1000; ++k) {
    const std::int64_t counts = random_code() / 32;
    const Scalar velocity = firmware::ScalarTraits<Scalar>::times(random_code(), p.tachometer_gain);
    cost.add(count([&] { loop.step(counts, velocity, Scalar(0)); }));
  }
  report("estimator_and_feedback", cost);
}

[[gnu::noinline]] Scalar filtered(firmware::ControlFilters<Scalar>& filters, Scalar value) {
  return filters.next(value);
}

/// Notch and low-pass, which a step calls if they are on.
void count_filters() {
  firmware::ControlFilters<Scalar> filters;
  const firmware::BiquadParameters<Scalar> notch{
      true, false, Scalar(0.56526f), Scalar(0.288f), Scalar(0.14674f), Scalar(-0.8f)};
  filters.configure({notch, {true, true, Scalar(0.20741f), Scalar(0.28548f), Scalar(0.39293f), Scalar(0)}});
  Cost cost;
  for (int k = 0; k < 1000; ++k) {
    const Scalar value = firmware::ScalarTraits<Scalar>::times(random_code(), Scalar(0.01f));
    cost.add(count([&] { filtered(filters, value); }));
  }
  report("control_filters", cost);
}

void start_motion() {
  for (std::size_t i = 0; i < Axes::kAxes; ++i) axes[i].configure(kParameters[i]);
  for (int period = 0; period <= firmware::kSelfTestSamples; ++period) {
    for (std::size_t i = 0; i < Axes::kAxes; ++i) {
      drives[i].bring_readings(io[i]);
      axes[i].step();
    }
  }
  for (std::size_t i = 0; i < Axes::kAxes; ++i) {
    axes[i].set_position(0);  // travel is watched
    axes[i].enable();
  }
}

/// Every way the reference can move: standing, a jog, a cut, a move.
void command(int period) {
  constexpr auto kMove = 12'000;
  for (std::size_t i = 0; i < Axes::kAxes; ++i) {
    Axes::BoardAxis& axis = axes[i];
    if (period == 50) axis.jog(kParameters[0].velocity_limit);
    if (period == 700) axis.stop();
    if (period == 1200) axis.start(axis.plan_move_to(firmware::CountPosition::at(kMove)).plan);
    if (period == 1400) axis.jog(Scalar(0) - kParameters[0].velocity_limit);
    if (period == 2400) axis.stop();
  }
}

void count_steps() {
  start_motion();
  Cost one, both;
  for (int period = 0; period < 3000; ++period) {
    command(period);
    for (std::size_t i = 0; i < Axes::kAxes; ++i) drives[i].bring_readings(io[i]);
    if (period % 2 == 0) {
      one.add(count([] { step_one<0>(); }));
      step_one<1>();
    } else {
      both.add(count([] { step_both(); }));
    }
  }
  report("one_axis", one);
  report("both_axes", both);
}

firmware::ExcitationPlan<Scalar> plan;
firmware::ExcitationRun<Scalar> excitation;
firmware::TriggeredMemory memory;
firmware::TriggeredCapture capture;

/// The largest number of lines at the controller's output, on top of a jog.
void start_multisine() {
  plan.kind = firmware::ExcitationKind::multisine;
  plan.input = firmware::ExcitationInput::output;
  plan.count = firmware::kExcitationEntries;
  plan.samples = 100'000;
  plan.period = plan.fade_samples = 1000;
  const auto volts = [](float value) {
    if constexpr (std::is_floating_point_v<Scalar>)
      return static_cast<Scalar>(value);
    else
      return Scalar(value / 1.25f);  // fixed_units.hpp, with steps of 20 V / 65536
  };
  plan.amplitude = plan.box.volts = volts(0.25f);
  plan.box.travel_counts = 1 << 20;
  plan.box.speed = 1 << 20;
  plan.box.drive_velocity = Scalar(1000.0f);
  constexpr auto kCountsPerVelocity =
      static_cast<float>(firmware_test::kPaperX.Ad12 / firmware_test::kEncoderResolution_mm);
  plan.box.counts_per_velocity = static_cast<Scalar>(std::is_floating_point_v<Scalar> ? kCountsPerVelocity : 1.0f);
  plan.ride = kParameters[0].velocity_limit;
  for (std::uint32_t i = 0; i < plan.count; ++i) plan.entry[i] = {volts(0.01f), (2 * i + 1) * 4294967u, i << 27};
  excitation.prepare(plan);
  excitation.start();
}

void start_capture() {
  firmware::TriggerRequest request{};
  request.every = 1;
  request.channels[0] = request.channels[1] = 1u << static_cast<unsigned>(firmware::Channel::counts) |
                                              1u << static_cast<unsigned>(firmware::Channel::position_error);
  request.kind = static_cast<std::uint8_t>(firmware::TriggerKind::edge);
  request.channel = static_cast<std::uint8_t>(firmware::Channel::position_error);
  request.level = 0x7F000000;  // never
  request.before = 1000;
  request.after = 1;
  capture.adopt(memory);
  capture.arm(request);
}

[[gnu::noinline]] void step_both_excited() {
  excitation.before_step(axes[0]);
  step_both();
}
[[gnu::noinline]] void take_row() { capture.take(axes); }

/// After count_steps(): both axes are enabled and at rest.
void count_experiments() {
  start_multisine();
  start_capture();
  Cost excited, captured;
  for (int period = 0; period < 2000; ++period) {
    for (std::size_t i = 0; i < Axes::kAxes; ++i) drives[i].bring_readings(io[i]);
    excited.add(count([] { step_both_excited(); }));
    captured.add(count([] { take_row(); }));
  }
  report("both_axes_excited", excited);
  report("captured_row", captured);
}

firmware::PathFollower<Axes::kAxes, 64> path;  // as on a board, more than a stop from full speed takes

[[gnu::noinline]] void step_both_on_path() {
  path.before_step(axes);
  step_both();
}
[[gnu::noinline]] void step_excited_and_on_path() {
  excitation.before_step(axes[0]);
  path.before_step(axes);
  step_both();
}

/// All axes are at rest afterwards.
void end_motion() {
  excitation.stop();
  path.stop();
  for (int period = 0; period < 2000; ++period) {
    for (std::size_t i = 0; i < Axes::kAxes; ++i) drives[i].bring_readings(io[i]);
    if (excitation.is_active()) excitation.before_step(axes[0]);
    path.prepare();
    if (path.is_moving()) path.before_step(axes);
    step_both();
  }
}

/// Back and forth in pieces of ten samples, each from speed to speed, and a feed hold on the way: every step of the
/// clock.
template <typename Step>
void count_path(const char* name, unsigned mask, Step step) {
  constexpr firmware::PathUnits kUnits{16, 24, 32};
  constexpr firmware::PathLimits kLimits{45.0F, 1.0F, 0.0267F};  // the clock changes by 1/125 a sample
  path.open(mask, kUnits, {axes[0].leading(), axes[1].leading()}, {kLimits, kLimits});
  path.hold(false);
  constexpr std::int32_t kPeriod = 64, kSpeed = 40;  // pieces, counts a sample
  Cost cost;
  std::int32_t piece = 0, speed = 0;
  for (int period = 0; period < 3000; ++period) {
    while (path.room() > 0) {
      // A triangle of speeds: constant acceleration except at its corners, which the nodes do not represent.
      const std::int32_t phase = (piece + kPeriod / 4) % kPeriod;
      const std::int32_t next =
          (phase < kPeriod / 2 ? phase - kPeriod / 4 : 3 * kPeriod / 4 - phase) * kSpeed * 4 / kPeriod;
      firmware::PathNode<Axes::kAxes> node;
      node.duration = 10 * firmware::kShortestPiece;
      for (auto& axis : node.axis) axis = {(speed + next) * 5 << 16, next << 24, 0};
      if (path.push(node, false, [](std::size_t, std::int64_t) { return true; }) != firmware::Refusal::none) break;
      speed = next;
      ++piece;
    }
    path.prepare();
    if (period == 0) path.start();
    if (period == 1500) path.hold(true);
    if (period == 2000) path.hold(false);
    for (std::size_t i = 0; i < Axes::kAxes; ++i) drives[i].bring_readings(io[i]);
    cost.add(count(step));
  }
  if (!path.is_moving()) hal::qemu::exit_emulator(2);
  report(name, cost);
}

/// After count_experiments().
void count_paths() {
  end_motion();
  count_path("both_axes_on_path", 3, step_both_on_path);
  end_motion();
  start_multisine();
  count_path("excited_and_on_path", 2, step_excited_and_on_path);
  if (!excitation.is_active()) hal::qemu::exit_emulator(3);
}

}  // namespace

extern "C" [[noreturn]] void run_board() {
  firmware::boards::arm_fault_detection();
  start_counting();
  std::uint32_t block = count([] {
#pragma GCC unroll 100
    for (int i = 0; i < 100; ++i) asm volatile("nop");
  });
  Cost nops;
  nops.add(block);
  report("100_nops", nops);
  count_estimator_and_feedback();
  count_filters();
  count_steps();
  count_experiments();
  count_paths();
  const bool ran = axes[0].telemetry().enabled && axes[1].telemetry().enabled;
  hal::qemu::exit_emulator(ran ? 0 : 1);
}
