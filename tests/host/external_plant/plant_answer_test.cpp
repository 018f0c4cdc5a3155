// The lines of axis-plant/1 as the contract writes them.
#include "host/external_plant/plant_answer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "host/exit_codes.hpp"

namespace {

using host::parse_plant_answer;
using testing::HasSubstr;

TEST(PlantLines, SayVoltsOrThatTheDriveIsDisabled) {
  EXPECT_EQ(host::plant_greeting(2, 0.001), "axis-plant/1 2 0.001\n");
  const std::array<std::optional<double>, 2> commands{-1.25, std::nullopt};
  EXPECT_EQ(host::plant_line(12, commands), "12 -1.25 off\n");
}

TEST(PlantAnswer, HoldsPositionAndTachometerOfEachAxis) {
  const auto readings = parse_plant_answer("3 1.5 -2e-3\t+4 -\r", 3, 2);
  ASSERT_EQ(readings.size(), 2u);
  EXPECT_EQ(readings[0].x, 1.5);
  EXPECT_EQ(readings[0].w, -2e-3);
  EXPECT_EQ(readings[1].x, 4.0);
  EXPECT_FALSE(readings[1].w.has_value());
}

TEST(PlantAnswer, IsRefusedWithWhatIsWrongAndHowItOughtToLook) {
  const std::array<std::array<const char*, 2>, 9> wrong{{{"", "0 fields where 3 belong"},
                                                         {"5 1.0", "2 fields"},
                                                         {"5 1.0 - -", "4 fields"},
                                                         {"4 1.0 -", "begins with '4' in period 5"},
                                                         {"5x 1.0 -", "begins with '5x'"},
                                                         {"5 nan -", "'nan' is no position"},
                                                         {"5 - 1", "'-' is no position"},
                                                         {"5 1.0 inf", "'inf' is no tachometer"},
                                                         {"5 1e10 0", "'1e10' is no position"}}};
  for (const auto& [line, what] : wrong) {
    try {
      parse_plant_answer(line, 5, 1);
      ADD_FAILURE() << line;
    } catch (const host::Failure& error) {
      EXPECT_EQ(error.code, host::ExitCode::protocol);
      EXPECT_THAT(error.what(), HasSubstr(what));
      EXPECT_THAT(error.what(), HasSubstr("\"5 X W\""));
    }
  }
}

TEST(PlantLines, ReadBackByAProgramThatIsTheMachine) {
  const auto greeting = host::parse_plant_greeting("axis-plant/1 2 0.001\r");
  EXPECT_EQ(greeting.axes, 2u);
  EXPECT_EQ(greeting.period_s, 0.001);
  for (const char* line : {"", "hello", "axis-plant/2 1 0.001", "axis-plant/1 0 0.001", "axis-plant/1 1.5 0.001",
                           "axis-plant/1 65 0.001", "axis-plant/1 1 0", "axis-plant/1 1 nan", "axis-plant/1 1"})
    EXPECT_THROW(host::parse_plant_greeting(line), host::Failure) << line;
  const auto commands = host::parse_plant_line("12 -1.25 off", 12, 2);
  EXPECT_EQ(commands[0], -1.25);
  EXPECT_FALSE(commands[1].has_value());
  for (const char* line : {"", "12 1", "11 1 2", "12 1 on", "12 inf 2", "12 1 2 3"})
    EXPECT_THROW(host::parse_plant_line(line, 12, 2), host::Failure) << line;
  const std::array<sim::ForeignReading, 2> readings{{{0.5, -2.0}, {7.25, std::nullopt}}};
  EXPECT_EQ(host::plant_answer(12, readings), "12 0.5 -2 7.25 -\n");
}

}  // namespace
