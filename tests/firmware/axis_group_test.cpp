// Several axes in one control period: the sensors that are read, and their order.
#include "firmware/core/supervision/axis_group.hpp"

#include <gtest/gtest.h>

#include <string>

#include "firmware/boards/pil/value_axis.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

/// Records when its encoder is read and its converter written.
struct NotedAxis : firmware::boards::ValueAxis {
  std::string* notes = nullptr;
  char name = ' ';

  struct NotedEncoder {
    NotedAxis& axis;
    hal::EncoderReading read() {
      *axis.notes += {'e', axis.name};
      return {.counts = 0, .valid = true};
    }
  } noted_encoder{*this};
  struct NotedDac {
    NotedAxis& axis;
    bool write(std::int32_t) {
      *axis.notes += {'d', axis.name};
      return true;
    }
    bool is_healthy() const { return true; }
  } noted_dac{*this};
  NotedEncoder& encoder() { return noted_encoder; }
  NotedDac& dac() { return noted_dac; }
};

/// Catches a step that reads its own encoder: the second axis' position would then be younger by the first one's
/// computing time.
TEST(AxisGroup, LatchesEveryEncoderBeforeItComputesAnAxis) {
  std::string notes;
  std::array<NotedAxis, 2> hal;
  for (std::size_t i = 0; i < hal.size(); ++i) {
    hal[i].notes = &notes;
    hal[i].name = static_cast<char>('x' + i);
  }
  firmware::AxisGroup<float, NotedAxis, 2> group(hal);
  for (std::size_t i = 0; i < hal.size(); ++i) {
    hal[i].tachometer().reading = {.code = 0, .valid = true};
    ASSERT_EQ(group[i].configure(firmware_test::parameters_of<float>(firmware_test::kPaperX)), firmware::Refusal::none);
  }
  notes.clear();
  group.step({});
  EXPECT_EQ(notes, "exeydxdy");
  notes.clear();
  group.step_with({1, 1}, {});
  EXPECT_EQ(notes, "exeydxdy");
}

}  // namespace
