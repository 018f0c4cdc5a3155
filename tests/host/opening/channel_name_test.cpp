// Meaning of channel names in the languages and conventions of controllers.
#include "host/opening/channel_name.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using host::ChannelQuantity;

host::ChannelName named(const std::string& name, const std::string& unit = "") {
  host::LogColumn column;
  column.name = name;
  column.unit = unit;
  return host::understand_name(column);
}

struct Case {
  const char* name;
  ChannelQuantity quantity;
  bool is_reference;
};

TEST(ChannelName, QuantityInSixLanguagesAndMore) {
  constexpr Case kCases[] = {
      {"Time(ms)", ChannelQuantity::time, false},
      {"Iq(A)", ChannelQuantity::current, false},
      {"ActPos(inc)", ChannelQuantity::position, false},
      {"SetPos(mm)", ChannelQuantity::position, true},
      {"Iist [A]", ChannelQuantity::current, false},
      {"Soll [mm]", ChannelQuantity::position, true},
      {"Lagesollwert [mm]", ChannelQuantity::position, true},
      {"Drehzahlistwert [1/min]", ChannelQuantity::speed, false},
      {"Drehmomentistwert [Nm]", ChannelQuantity::torque, false},
      {"Schleppabstand [mm]", ChannelQuantity::other, false},
      {"Position réelle [mm]", ChannelQuantity::position, false},
      {"Vitesse de consigne (tr/min)", ChannelQuantity::speed, true},
      {"Courant moteur [A]", ChannelQuantity::current, false},
      {"Posición real (mm)", ChannelQuantity::position, false},
      {"Velocidad (mm/s)", ChannelQuantity::speed, false},
      {"Corriente [A]", ChannelQuantity::current, false},
      {"Posizione attuale [mm]", ChannelQuantity::position, false},
      {"Coppia [Nm]", ChannelQuantity::torque, false},
      {"Положение, мм", ChannelQuantity::position, false},
      {"Скорость [рад/с]", ChannelQuantity::speed, false},
      {"Ток [А]", ChannelQuantity::current, false},
      {"Время, мс", ChannelQuantity::time, false},
      {"实际位置(mm)", ChannelQuantity::position, false},
      {"指令位置(mm)", ChannelQuantity::position, true},
      {"电流(A)", ChannelQuantity::current, false},
      {"回転数[rpm]", ChannelQuantity::speed, false},
      {"X1_ActualAcceleration", ChannelQuantity::other, false},
      {"X1_DCBusVoltage", ChannelQuantity::other, false},
      {"velCmd", ChannelQuantity::speed, true},
  };
  for (const Case& expected : kCases) {
    const host::ChannelName name = named(expected.name);
    EXPECT_EQ(host::quantity_name(name.quantity), host::quantity_name(expected.quantity)) << expected.name;
    EXPECT_EQ(name.is_reference, expected.is_reference) << expected.name;
  }
}

TEST(ChannelName, UnitsAndTheirFactors) {
  const auto factor = [](const char* name) {
    const auto unit = named(name).unit;
    return unit ? unit->factor : 0.0;
  };
  EXPECT_DOUBLE_EQ(factor("Zeit / ms"), 1e-3);
  EXPECT_DOUBLE_EQ(factor("speed_rpm"), std::numbers::pi / 30.0);
  EXPECT_DOUBLE_EQ(factor("Drehzahl [U/min]"), std::numbers::pi / 30.0);
  EXPECT_DOUBLE_EQ(factor("w_rad_s"), 1.0);
  EXPECT_DOUBLE_EQ(factor("pos (°)"), std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(factor("pos_turns"), 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(factor("Weg, µm"), 1e-3);
  EXPECT_DOUBLE_EQ(factor("current [mA]"), 1e-3);
  EXPECT_DOUBLE_EQ(factor("pos [in]"), 25.4);
}

TEST(ChannelName, WordsThatLookLikeUnitsAreNone) {
  EXPECT_FALSE(named("current_in").unit);  // not an inch
  EXPECT_EQ(named("current_in").quantity, ChannelQuantity::other);
}

TEST(ChannelName, AxesByLettersAndNumbers) {
  EXPECT_EQ(named("X1_ActualPosition").axis, "x1");
  EXPECT_EQ(named("pos (3)").axis, "3");
  EXPECT_EQ(named("Analog 2 Torque").axis, "");  // a channel of the logger, not an axis
}

}  // namespace
