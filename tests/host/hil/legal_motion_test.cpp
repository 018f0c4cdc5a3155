// No monitor reports a fault in the most demanding permitted motion on the worst permitted drives.
#include <gtest/gtest.h>

#include "host/hil/machine.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/parameters/axis_parameters.hpp"

namespace {

using firmware::AxisFault;
using host::Machine;

/// The paper's drives with designs for them; `worn` adds effects of a drive in service.
std::array<host::MachineAxis, 2> machine_axes(bool worn) {
  std::array<host::MachineAxis, 2> axes;
  for (std::size_t i = 0; i < 2; ++i) {
    axes[i].drive = *host::paper_drive(host::kAxisNames[i]);
    const auto design = host::design_axis(axes[i].drive, {});
    axes[i].parameters = axis_parameters(axes[i].drive, design, axes[i].wiring.tachometer_resolution);
    if (!worn) continue;
    axes[i].drive.effects.push_back({"tach_gain", {{"gain", 1.02}}, {}, {}});
    axes[i].drive.effects.push_back({"constant_torque", {{"torque", 1.0}}, {}, {}});
  }
  return axes;
}

class HardestLegalMotion : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Machines, HardestLegalMotion, testing::Bool(),
                         [](const auto& worn) { return worn.param ? "worn" : "as_designed"; });

TEST_P(HardestLegalMotion, TripsNothing) {
  Machine machine(machine_axes(GetParam()), 5);
  machine.enable();
  auto& axes = machine.axes();
  constexpr std::int64_t kStep_counts = 60'000;  // 146 mm
  int turn = 0;
  for (int k = 0; k < 20'000; ++k) {
    if (k % 450 == 0) {  // full speed one way, and full reversal before it is reached every third time
      const float speed = (turn++ % 3 == 2) ? 400.0f : 250.0f;
      const int sign = turn % 2 == 0 ? 1 : -1;
      const float velocity = turn % 2 == 0 ? speed : -speed;
      if (k < 10'000) {
        axes[0].jog(velocity);
        axes[1].jog(-velocity);
      } else if (axes[0].is_at_rest() && axes[1].is_at_rest()) {
        const auto target = firmware::CountPosition::at(sign * kStep_counts);
        for (std::size_t i = 0; i < 2; ++i) axes[i].start(axes[i].plan_move_to(target).plan);
      } else {
        for (std::size_t i = 0; i < 2; ++i) axes[i].stop();
      }
    }
    machine.step();
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_EQ(axes[i].fault(), AxisFault::none)
          << "sample " << k << ": " << firmware::fault_info(axes[i].fault()).name;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(axes[i].monitors().high_water(), 0.02f);
    EXPECT_LT(axes[i].monitors().high_water(), 0.4f) << "leaves little room under the limit of 0.5 mm at standstill";
  }
}

}  // namespace
