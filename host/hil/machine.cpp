#include "host/hil/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"

namespace host {

namespace {

std::unique_ptr<sim::Plant> make_plant(const MachineAxis& axis, std::uint64_t seed) {
  auto plant = std::make_unique<sim::Plant>(axis.drive, seed);
  if (axis.motion) plant->hand_over(axis.motion);
  return plant;
}

template <typename Make>
auto for_each_axis(Make make) {
  std::array<decltype(make(0)), hal::kAxisCount> made;
  for (std::size_t i = 0; i < made.size(); ++i) made[i] = make(i);
  return made;
}

}  // namespace

Machine::Machine(const std::array<MachineAxis, hal::kAxisCount>& axes, std::uint64_t seed)
    : period_s_(axes[0].drive.data.sample_period_s),
      plants_(for_each_axis([&](std::size_t i) { return make_plant(axes[i], hal::kAxisCount * seed + i); })),
      wires_(for_each_axis([&](std::size_t i) {
        return std::make_unique<hal::pc::FaultyAxis>(*plants_[i], axes[i].wiring, hal::kAxisCount * seed + i);
      })),
      axes_([this](std::size_t i) -> hal::pc::FaultyAxis& { return *wires_[i]; }) {
  axes_.board().configure(firmware::BoardWatch::default_limits(static_cast<float>(period_s_)));
  axes_.board().host_commands(true);
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    const auto error = axes_[i].configure(axes[i].parameters);
    if (error != firmware::Refusal::none) {
      throw Failure(ExitCode::bad_input, fmt::format("axis {} rejects its parameters (parameter error {})",
                                                     kAxisNames[i], static_cast<int>(error)));
    }
    axes_[i].set_position(0);  // counts start at the initial positions of the plants
  }
}

firmware::BoardInputs Machine::inputs() {
  if (!defects.host_silent) axes_.board().host_heard();
  const bool is_powered = !defects.emergency_stop && !defects.power_lost && axes_.may_have_power();
  for (auto& wires : wires_) wires->set_powered(is_powered);
  return {clock_.now_us(), defects.emergency_stop, defects.power_lost, defects.store_damaged};
}

void Machine::run_plants() {
  for (auto& wires : wires_) wires->advance(period_s_);
  clock_.advance_us(static_cast<std::uint32_t>(std::lround(1e6 * period_s_)));
  ++samples_;
}

std::array<firmware::Increment, hal::kAxisCount> Machine::runaway() {
  std::array<firmware::Increment, hal::kAxisCount> added{};
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    if (defects.runaway_mm_s2[i] == 0.0) continue;
    runaway_mm_s_[i] += defects.runaway_mm_s2[i] * period_s_;
    const double counts = runaway_mm_s_[i] * period_s_ / plants_[i]->data().encoder_resolution;
    constexpr double kMostCounts = 16'000.0;  // range of the references, motion_limits.hpp
    added[i] = std::llround(std::clamp(counts, -kMostCounts, kMostCounts) * static_cast<double>(firmware::kOneCount));
  }
  return added;
}

void Machine::step() {
  if (defects.runaway_mm_s2 == decltype(defects.runaway_mm_s2){})
    axes_.step(inputs());
  else
    axes_.step_with(runaway(), inputs());
  run_plants();
}

void Machine::step_with(const std::array<firmware::Increment, hal::kAxisCount>& increments) {
  auto sum = runaway();
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) sum[i] += increments[i];
  axes_.step_with(sum, inputs());
  run_plants();
}

void Machine::lose_periods(int periods) {
  for (int i = 0; i < periods; ++i) run_plants();
}

void Machine::enable() {
  for (int k = 0; k <= firmware::kSelfTestSamples; ++k) step();
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) axes_[i].enable();
  step();
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    if (axes_[i].state() == firmware::SupervisorState::enabled) continue;
    throw Failure(ExitCode::device_fault, fmt::format("axis {} cannot be enabled: {}", kAxisNames[i],
                                                      firmware::fault_info(axes_[i].fault()).cause));
  }
}

}  // namespace host
