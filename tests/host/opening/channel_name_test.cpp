// Meaning of channel names in the languages and conventions of controllers.
#include "host/opening/channel_name.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using host::Quantity;

host::ChannelName named(const std::string& name, const std::string& unit = "") {
  host::LogColumn column;
  column.name = name;
  column.unit = unit;
  return host::understand_name(column);
}

struct Case {
  const char* name;
  Quantity quantity;
  bool is_reference;
};

TEST(ChannelName, QuantityInSixLanguagesAndMore) {
  constexpr Case kCases[] = {
      {"Time(ms)", Quantity::time, false},
      {"Iq(A)", Quantity::current, false},
      {"ActPos(inc)", Quantity::position, false},
      {"SetPos(mm)", Quantity::position, true},
      {"Iist [A]", Quantity::current, false},
      {"Soll [mm]", Quantity::position, true},
      {"Lagesollwert [mm]", Quantity::position, true},
      {"Drehzahlistwert [1/min]", Quantity::speed, false},
      {"Drehmomentistwert [Nm]", Quantity::torque, false},
      {"Schleppabstand [mm]", Quantity::other, false},
      {"Position réelle [mm]", Quantity::position, false},
      {"Vitesse de consigne (tr/min)", Quantity::speed, true},
      {"Courant moteur [A]", Quantity::current, false},
      {"Posición real (mm)", Quantity::position, false},
      {"Velocidad (mm/s)", Quantity::speed, false},
      {"Corriente [A]", Quantity::current, false},
      {"Posizione attuale [mm]", Quantity::position, false},
      {"Coppia [Nm]", Quantity::torque, false},
      {"Положение, мм", Quantity::position, false},
      {"Скорость [рад/с]", Quantity::speed, false},
      {"Ток [А]", Quantity::current, false},
      {"Время, мс", Quantity::time, false},
      {"实际位置(mm)", Quantity::position, false},
      {"指令位置(mm)", Quantity::position, true},
      {"电流(A)", Quantity::current, false},
      {"回転数[rpm]", Quantity::speed, false},
      {"X1_ActualAcceleration", Quantity::other, false},
      {"X1_DCBusVoltage", Quantity::other, false},
      {"velCmd", Quantity::speed, true},
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
  EXPECT_EQ(named("current_in").quantity, Quantity::other);
}

TEST(ChannelName, AxesByLettersAndNumbers) {
  EXPECT_EQ(named("X1_ActualPosition").axis, "x1");
  EXPECT_EQ(named("pos (3)").axis, "3");
  EXPECT_EQ(named("Analog 2 Torque").axis, "");  // a channel of the logger, not an axis
}

}  // namespace
