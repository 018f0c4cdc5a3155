// A test whose registers are answered by the parts, and which ends with a failure if a part has complained.
#pragma once

#include <gtest/gtest.h>

#include "tests/hal/parts/chip.hpp"

namespace driver_test {

class OnChip : public testing::Test {
 protected:
  void TearDown() override { EXPECT_EQ(chip.bus.complaints(), std::vector<std::string>{}); }

  parts::Chip chip;
};

/// Clocks and peripherals run as start-up leaves them.
class OnRunningChip : public OnChip {
 protected:
  void SetUp() override { chip.run_at_full_speed(); }
};

}  // namespace driver_test
