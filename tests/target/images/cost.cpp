// Image that counts the instructions of the control law: estimator and feedback alone, one axis, both axes.
#include <array>
#include <cstdint>

#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/axis.hpp"
#include "firmware/core/fixed_units.hpp"
#include "tests/firmware/paper_axes.hpp"
#include "tests/target/images/instruction_counter.hpp"

namespace firmware::boards {
void make_outputs_safe() noexcept {}
}  // namespace firmware::boards

extern "C" void control_interrupt() {}

namespace {

using namespace target_image;
using firmware::boards::ValueAxis;
using Scalar = AXIS_COST_SCALAR;
using BoardAxis = firmware::Axis<Scalar, ValueAxis>;

template <typename T>
constexpr firmware::AxisParameters<T> in_scalar(const firmware_test::PaperAxis& axis) {
  if constexpr (std::is_floating_point_v<T>)
    return firmware_test::parameters_of<T>(axis);
  else
    return firmware::to_fixed(firmware_test::parameters_of<double>(axis));
}

constexpr firmware::AxisParameters<Scalar> with_everything_on(const firmware_test::PaperAxis& axis) {
  firmware::AxisParameters<Scalar> p = in_scalar<Scalar>(axis);
  p.friction_feedforward_on = p.zero_phase_feedforward_on = p.disturbance_cancellation_on = true;
  return p;
}

// Computed by the compiler: the image holds numbers, not the conversion.
constexpr std::array kParameters{with_everything_on(firmware_test::kPaperX),
                                 with_everything_on(firmware_test::kPaperY)};

std::array<ValueAxis, 2> io;
[[gnu::section(".ccm")]] std::array<BoardAxis, 2> axes{BoardAxis(io[0]), BoardAxis(io[1])};

std::uint32_t random_state = 1;
std::int32_t random_code() {  // minimal standard generator's low-cost cousin: quality is of no matter here
  random_state = random_state * 1664525u + 1013904223u;
  return static_cast<std::int32_t>(random_state >> 24) - 128;
}

/// The encoder follows the reference within a few counts, the tachometer reports noise around it.
void bring_readings(std::size_t axis) {
  const auto counts = static_cast<std::int32_t>(axes[axis].telemetry().reference.counts);
  io[axis].encoder().reading = {static_cast<std::uint32_t>(counts + random_code() / 32), true};
  io[axis].tachometer().reading = {random_code(), true};
}

[[gnu::noinline]] void step_one(BoardAxis& axis) { axis.step(); }
[[gnu::noinline]] void step_both() {
  for (BoardAxis& axis : axes) axis.step();
}

struct EstimatorAndFeedback {
  firmware::KalmanEstimator<Scalar> estimator;
  Scalar Kc1{}, Kc2{}, u{};

  [[gnu::noinline]] void step(std::int64_t counts, Scalar velocity, Scalar reference) {
    estimator.update(u, counts, velocity);
    u = Kc1 * (reference - estimator.estimate().offset) - Kc2 * estimator.estimate().velocity;
  }
};

void count_estimator_and_feedback() {
  EstimatorAndFeedback loop;
  const auto& p = kParameters[0];
  loop.estimator.configure(p.drive, p.Kobs, p.encoder_resolution);
  loop.estimator.reset(0);
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

void start_motion() {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].configure(kParameters[i]);
    bring_readings(i);
    axes[i].step();
    axes[i].enable();
  }
}

/// Every way the reference can move: standing, a jog, a cut, a move.
void command(int period) {
  constexpr auto kMove = 12'000;
  for (BoardAxis& axis : axes) {
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
    for (std::size_t i = 0; i < axes.size(); ++i) bring_readings(i);
    if (period % 2 == 0) {
      one.add(count([] { step_one(axes[0]); }));
      axes[1].step();
    } else {
      both.add(count([] { step_both(); }));
    }
  }
  report("one_axis", one);
  report("both_axes", both);
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
  count_steps();
  const bool ran = axes[0].telemetry().enabled && axes[1].telemetry().enabled;
  hal::qemu::exit_emulator(ran ? 0 : 1);
}
