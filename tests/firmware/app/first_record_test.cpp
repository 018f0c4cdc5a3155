// The first record of an axis without a design: amplifier and brake act in the same order as in a closed loop.
#include <gtest/gtest.h>

#include "tests/firmware/app/board_on_a_bench.hpp"

namespace {

using firmware::ExcitationEnd;
using firmware::ExcitationPhase;
using firmware::Status;
using firmware_test::set;

constexpr int kRelease = 80, kApply = 60, kWait = 100;

class FirstRecord : public testing::Test {
 protected:
  FirstRecord() {
    firmware::ParameterValues values = firmware_test::paper_values();
    set(values, "x.drive.fitted", 0);
    set(values, "y.drive.fitted", 0);
    set(values, "x.brake.fitted", 1);
    set(values, "x.brake.release_time", 1e-3 * kRelease);
    set(values, "x.brake.apply_time", 1e-3 * kApply);
    set(values, "x.amplifier.ready_time", 1e-3 * kWait);
    values_ = values;
  }
  Status excite() {
    EXPECT_EQ(bench.download(values_).status, Status::ok);
    bench.run(100);
    firmware::ExcitationRequest request;
    request.kind = static_cast<std::uint8_t>(firmware::ExcitationKind::chirp);
    request.travel_counts = 40'000;
    request.speed = 100.0F;
    request.volts = request.amplitude = 6000.0F;
    request.samples = 500;
    request.step = request.last_step = 40 * 4294967u;  // 40 Hz
    firmware::RefusedValuePayload refused;
    const Status status = bench.application.excite(request, refused);
    bench.application.become_owner(1);
    return status;
  }
  void period() {
    bench.run(1);
    bench.application.owner_heard(1);
  }
  auto& lines() { return bench.board.axis(0).drive_enable(); }
  firmware::ExcitationStatePayload state() { return bench.application.excitation_state(); }

  firmware_test::BoardOnABench<> bench;
  firmware::ParameterValues values_{2};
};

TEST_F(FirstRecord, ReleasesTheBrakeBeforeItDrivesAndAppliesItBeforeItLetsGo) {
  ASSERT_EQ(excite(), Status::ok);
  int energised = 0, released = 0, driven_against_brake = 0, held = 0;
  for (int k = 0; k < 5000 && bench.application.any_enabled(); ++k) {
    period();
    const bool drives = bench.application.axes()[0].telemetry().dac_code != 0;
    if (lines().is_on() && !lines().is_brake_released() && !drives && released == 0) ++energised;
    if (lines().is_brake_released() && !drives && state().elapsed == 0) ++released;
    if (drives && !lines().is_brake_released()) ++driven_against_brake;
    if (lines().is_on() && !lines().is_brake_released() && released != 0) ++held;
  }
  EXPECT_EQ(state().end, static_cast<std::uint8_t>(ExcitationEnd::completed));
  EXPECT_EQ(driven_against_brake, 0);
  EXPECT_GE(energised, kWait);
  EXPECT_GE(released, kRelease - 1);
  EXPECT_GE(held, kApply - 1);
  EXPECT_FALSE(lines().is_on());
}

TEST_F(FirstRecord, IsRefusedWhereTheReadyContactHasNoTime) {
  set(values_, "x.amplifier.ready_input", 1);
  set(values_, "x.amplifier.ready_time", 0);
  EXPECT_EQ(excite(), Status::malformed);
  EXPECT_FALSE(bench.application.any_enabled());
}

}  // namespace
