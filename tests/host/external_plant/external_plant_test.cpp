// External programs as the machine, including faulty ones.
#include "host/external_plant/external_plant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

using host::ExitCode;
using host::ExternalPlant;
using testing::HasSubstr;

constexpr std::chrono::milliseconds kPatience{2000}, kLittle{60};

std::shared_ptr<ExternalPlant> start(const std::string& script, std::size_t axes = 1,
                                     std::chrono::milliseconds patience = kPatience) {
  return std::make_shared<ExternalPlant>(script, axes, 0.001, patience);
}

template <typename Work>
void expect_end(Work work, ExitCode code, const std::string& words) {
  try {
    work();
    ADD_FAILURE() << "goes on";
  } catch (const host::Failure& error) {
    EXPECT_EQ(error.code, code) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

/// Catches an exchange before all axes have set their voltage, and a separate exchange for each axis.
TEST(AnExternalPlant, IsAskedOnceAPeriodWithTheVoltsOfAllAxes) {
  const auto plant = start("read hello; echo ready; while read k a b; do echo $k $a 1 $b -; done", 2);
  const auto x = ExternalPlant::axis(plant, 0), y = ExternalPlant::axis(plant, 1);
  for (const double volts : {1.5, -2.0}) {
    x->command(volts);
    y->command(3.0 * volts);
    x->advance(0.001);
    y->advance(0.001);
    EXPECT_EQ(x->reading().x, volts);
    EXPECT_EQ(y->reading().x, 3.0 * volts);
    EXPECT_EQ(x->reading().w, 1.0);
    EXPECT_FALSE(y->reading().w.has_value());
  }
}

TEST(AnExternalPlant, IsToldThatTheDriveIsDisabled) {
  const auto plant =
      start("read hello; echo ready; while read k u; do [ $u = off ] && echo $k 7 - || echo $k 8 -; done");
  const auto x = ExternalPlant::axis(plant, 0);
  x->advance(0.001);
  EXPECT_EQ(x->reading().x, 7.0);
  x->command(0.0);
  x->advance(0.001);
  EXPECT_EQ(x->reading().x, 8.0);
}

TEST(AnExternalPlant, GetsAsManyLinesAsItsPeriodsGoIntoTheBoards) {
  const auto plant = start("read hello; echo ready; while read k u; do echo $k $k -; done");
  const auto x = ExternalPlant::axis(plant, 0);
  x->advance(0.004);
  EXPECT_EQ(x->reading().x, 3.0);
  expect_end([&] { x->advance(0.0005); }, ExitCode::bad_input, "control.rate = 1000");
}

TEST(AnExternalPlant, ThatDoesNotGreetIsRefused) {
  expect_end([] { start("read hello; echo hello"); }, ExitCode::protocol, "last said 'hello'");
  expect_end([] { start("/no/such/program"); }, ExitCode::no_such_device, "exit status 127");
}

TEST(AnExternalPlant, ThatDiesEndsTheRunWithWhatItLastSaid) {
  const auto plant = start("read hello; echo ready; read line; echo 0 0.25 -; read line; echo oops; exit 3");
  const auto x = ExternalPlant::axis(plant, 0);
  x->advance(0.001);
  expect_end([&] { x->advance(0.001); }, ExitCode::protocol, "last said 'oops'");
  const auto other = start("read hello; echo ready; read line; echo 0 0.25 -; read line; exit 3");
  const auto y = ExternalPlant::axis(other, 0);
  y->advance(0.001);
  expect_end([&] { y->advance(0.001); }, ExitCode::no_such_device, "(exit status 3); it last said '0 0.25 -'");
}

TEST(AnExternalPlant, ThatIsKilledEndsTheRun) {
  const auto plant = start("read hello; echo ready; read line; kill -9 $$");
  const auto x = ExternalPlant::axis(plant, 0);
  expect_end([&] { x->advance(0.001); }, ExitCode::no_such_device, "signal 9");
}

TEST(AnExternalPlant, ThatHangsEndsTheRunAfterThePatienceAndIsKilled) {
  const auto plant = start("trap '' TERM; read hello; echo ready; read line; while :; do sleep 1; done", 1, kLittle);
  const auto x = ExternalPlant::axis(plant, 0);
  expect_end([&] { x->advance(0.001); }, ExitCode::time_out, "does not answer in time");
}

TEST(AnExternalPlant, ThatNeverEndsItsLineIsRefused) {
  const auto plant = start("read hello; echo ready; read line; yes x | tr -d '\\n'");
  const auto x = ExternalPlant::axis(plant, 0);
  expect_end([&] { x->advance(0.001); }, ExitCode::protocol, "a line without end");
}

}  // namespace
