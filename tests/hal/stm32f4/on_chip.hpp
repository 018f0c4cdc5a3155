// A test in which models of the peripherals simulate the registers; it fails if a model reports a wrong access.
#pragma once

#include <gtest/gtest.h>

#include "tests/hal/parts/chip.hpp"

namespace driver_test {

class OnChip : public testing::Test {
 protected:
  void TearDown() override { EXPECT_EQ(chip.bus.complaints(), std::vector<std::string>{}); }

  parts::Chip chip;
};

/// Clocks and peripherals run as after start-up.
class OnRunningChip : public OnChip {
 protected:
  void SetUp() override { chip.run_at_full_speed(); }
};

}  // namespace driver_test
