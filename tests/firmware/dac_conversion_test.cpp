#include "firmware/core/control/dac_conversion.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

firmware::DacConversion<float> sixteen_bits() {
  firmware::DacConversion<float> dac;
  dac.configure(20.0f / 65536.0f, 10.0f);
  return dac;
}

TEST(DacConversion, RoundsToTheNearestCodeHalvesAwayFromZero) {
  const auto dac = sixteen_bits();
  const float step = 20.0f / 65536.0f;
  EXPECT_EQ(dac(0.0f).code, 0);
  EXPECT_EQ(dac(0.49f * step).code, 0);
  EXPECT_EQ(dac(0.51f * step).code, 1);
  EXPECT_EQ(dac(-0.51f * step).code, -1);
  EXPECT_EQ(dac(1.0f).code, 3277);    // 3276.8
  EXPECT_EQ(dac(-2.0f).code, -6554);  // -6553.6
  for (int code = -32767; code <= 32767; ++code) {
    const auto word = dac(static_cast<float>(code) * step);
    ASSERT_EQ(word.code, code);
    ASSERT_EQ(word.volts, static_cast<float>(code) * step);
    ASSERT_FALSE(word.saturated);
  }
}

TEST(DacConversion, LimitsSymmetricallyAndSaysSo) {
  const auto dac = sixteen_bits();
  EXPECT_EQ(dac.max_code(), 32767);
  for (const float volts : {10.0f, 11.0f, 1e30f, std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(dac(volts).code, 32767);
    EXPECT_TRUE(dac(volts).saturated);
    EXPECT_EQ(dac(-volts).code, -32767);
    EXPECT_EQ(dac(-volts).volts, -dac(volts).volts);
  }
  EXPECT_LT(dac(1e30f).volts, 10.0f);
}

}  // namespace
