// Simulated drives over axis-plant/1, against hand calculations.
#include "host/external_plant/plant_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"

namespace {

using testing::HasSubstr;

/// 1 Nm per V; 0.01 kg m^2 without friction; one count per 0.5 mm.
sim::DriveDescription drive() {
  return host::parse_model(
      "format = \"axis-model/1\"\nname = \"x\"\n[drive]\nkind = \"rotary\"\namplifier_gain_A_per_V = 2.0\n"
      "torque_constant_Nm_per_A = 0.5\nlead_mm_per_rad = 2.0\nsample_period_s = 0.01\n[drive.encoder]\n"
      "resolution_mm = 0.5\n[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = 0.01\n",
      "x.toml");
}

std::string served(const std::string& input, std::size_t axes = 1) {
  std::istringstream in(input);
  std::ostringstream out;
  host::serve_plant(std::vector<sim::DriveDescription>(axes, drive()), 1, in, out);
  return out.str();
}

/// 1.1 V for 0.1 s: 110 rad/s^2 t^2 / 2 = 0.55 rad = 1.1 mm, at 11 rad/s; disabled, it coasts to 3.3 mm. The counter
/// rounds down.
TEST(AServedPlant, MovesByTheVoltsThatItIsTold) {
  EXPECT_EQ(served("axis-plant/1 2 0.1\n0 1.1 -1.1\n1 off off\n", 2), "ready\n0 1 - -1.5 -\n1 3 - -3.5 -\n");
}

TEST(AServedPlant, EndsWithItsInputAndRefusesNonsense) {
  EXPECT_EQ(served(""), "");
  for (const auto& [input, what] :
       {std::pair{"hello\n", "axis-plant/1 AXES"}, std::pair{"axis-plant/1 3 0.001\n", "--axes 3"},
        std::pair{"axis-plant/1 1 0.001\n0 0\n2 0\n", "in period 1"}})
    try {
      served(input);
      ADD_FAILURE() << input;
    } catch (const host::Failure& refused) {
      EXPECT_EQ(refused.code, host::ExitCode::protocol);
      EXPECT_THAT(refused.what(), HasSubstr(what));
    }
}

}  // namespace
