// axistool run with a simulated board of two axes on Linux' own USB stack: the paper's circle, and hosts that die or
// send nothing in the middle of an arc. Runs in the guest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/device/board_client.hpp"
#include "host/model/model_file.hpp"
#include "tests/guest/support/child.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using guest_test::Child;
using testing::HasSubstr;

const std::string kModel = AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml";
const std::string kPatient = "host.timeout=10";  // beyond the eight seconds of nodes that a board holds
constexpr double kCount_mm = 0.00244140625, kRadius_mm = 35.0;

class UsbPath : public testing::TestWithParam<host::HidBackend> {
 protected:
  void SetUp() override {
    if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/run.sh";
    ASSERT_TRUE(guest_test::boards_become(0, library(), 20s)) << "the board of the test before";
    board_ =
        std::make_unique<Child>(std::vector<std::string>{AXISTOOL_PROGRAM, "sim", "--usb", "--serial", "BENCH",
                                                         "--flash", file("usb.flash"), "--x", kModel, "--y", kModel});
    ASSERT_TRUE(guest_test::boards_become(1, library(), 20s));
  }

  const host::HidLibrary& library() const { return host::hid_library(GetParam()); }
  std::string file(const char* name) const { return folder_.path(name); }
  std::string program(const char* name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  ProgramRun run(const std::string& arguments, const char* streams = "2>&1") const {
    return run_program("AXISTOOL_HIDAPI=" + std::string(host::name_of(GetParam())) + " timeout 120 " +
                           AXISTOOL_PROGRAM + " " + arguments + " --device usb:BENCH",
                       streams);
  }

  /// Both axes are the same drive, with a design for it, and count from where they stand.
  void fit(const std::string& more) const {
    ASSERT_EQ(run_axistool("design " + kModel + " -o " + file("x.toml")).exit_code, 0);
    std::ifstream in(file("x.toml"));
    std::string text{std::istreambuf_iterator<char>(in), {}};
    for (std::size_t at = 0; (at = text.find("[x.", at)) != std::string::npos;) text[at + 1] = 'y';
    ASSERT_EQ(run("set-params " + file("x.toml") + " " + more).exit_code, 0);
    ASSERT_EQ(run("set-params " + program("y.toml", text)).exit_code, 0);
    for (const char* axis : {"x", "y"}) ASSERT_EQ(run(std::string("home ") + axis + " --here").exit_code, 0);
  }

  /// Half a minute of a slow circle, in the background and silent.
  std::unique_ptr<Child> start_long_arc() const {
    const std::string arc = program("arc.ngc", "F1200 G3 X0 Y0 I35 J0\nM2\n");
    return std::make_unique<Child>(std::vector<std::string>{"sh", "-c",
                                                            "exec " AXISTOOL_PROGRAM " run " + arc +
                                                                " --yes --device usb:BENCH --json " + file("run.json") +
                                                                " 2>/dev/null"});
  }

  struct Place {
    double x_mm = 0.0, y_mm = 0.0;
    bool stands = false, is_on = false;
    double off_um() const { return 1e3 * std::abs(std::hypot(x_mm - kRadius_mm, y_mm) - kRadius_mm); }
  };
  Place place() const {
    host::BoardClient board(host::open_usb_board("BENCH", library()), 10s);
    const host::BoardState state = board.status();
    Place place{static_cast<double>(state.axis[0].counts()) * kCount_mm,
                static_cast<double>(state.axis[1].counts()) * kCount_mm, true, false};
    for (int axis = 0; axis < 2; ++axis) {
      place.stands = place.stands && (state.axis[axis].flags & firmware::kAxisAtRest) != 0;
      place.is_on = place.is_on || state.axis[axis].state == static_cast<int>(firmware::SupervisorState::enabled);
    }
    return place;
  }
  /// Until the arc is half a radius under way.
  void await_motion() const {
    for (int tries = 0; tries < 400 && place().y_mm > -0.5 * kRadius_mm && place().y_mm < 0.5 * kRadius_mm; ++tries)
      std::this_thread::sleep_for(20ms);
  }

  TemporaryFolder folder_;
  std::unique_ptr<Child> board_;
};

/// Four turns of the paper's circle, at 170 mm/s: the noise of the sensors differs from run to run, and four turns of
/// it by less than 1 %.
TEST_P(UsbPath, FollowsTheCircleAsNearAsWithoutUsb) {
  fit(kPatient);
  const std::string text = "F10200 G3 X0 Y0 I35 J0\nG3 X0 Y0 I35 J0\nG3 X0 Y0 I35 J0\nG3 X0 Y0 I35 J0\nM2\n";
  const ProgramRun done = run("run " + program("circle.ngc", text) + " --yes --json -", "2>/dev/null");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const auto by_usb = nlohmann::json::parse(done.output);
  EXPECT_EQ(by_usb["stopped_because"], "completed");
  EXPECT_EQ(by_usb["lost_rows"], 0);
  const double rms_um = by_usb["contour_rms_um"];
  const double alone_um =
      guest_test::contour_rms_in_process(host::read_model(kModel), {file("x.toml"), file("y.toml")}, text);
  std::cout << "contour error by USB " << rms_um << " um rms, " << by_usb["contour_um"] << " at most; in one process "
            << alone_um << " rms\n";
  EXPECT_NEAR(rms_um, alone_um, 0.05 * alone_um);
  EXPECT_GT(rms_um, 0.3) << "an encoder of 2.4 um sees no less";
}

/// Two seconds of silence are a lost host; the ramp from 20 mm/s takes less than another half. Time here goes by the
/// guest's instructions: a busy computer does not change it.
TEST_P(UsbPath, AKilledHostLeavesAxesThatStandOnThePath) {
  fit("host.timeout=2");
  auto host = start_long_arc();
  await_motion();
  ASSERT_FALSE(place().stands);
  host->kill();
  const auto killed = Clock::now();
  Place last = place();
  while (!last.stands && Clock::now() - killed < 20s) last = place();
  const double waited_s = std::chrono::duration<double>(Clock::now() - killed).count();
  std::cout << "stands " << waited_s << " s after the host's end, " << last.off_um() << " um off the circle\n";
  EXPECT_TRUE(last.stands);
  EXPECT_LT(waited_s, 3.0);
  EXPECT_LT(last.off_um(), 10.0);
  EXPECT_THAT(run("faults").output, HasSubstr("host_heartbeat_lost"));
}

/// The host stands still for longer than the nodes last, and the board waits for it longer than that.
TEST_P(UsbPath, AStarvedPathEndsOnThePath) {
  fit(kPatient);
  auto host = start_long_arc();
  await_motion();
  host->pause();
  const auto paused = Clock::now();
  while (!place().stands && Clock::now() - paused < 20s) std::this_thread::sleep_for(20ms);
  const Place last = place();
  host->go_on();
  host->wait();
  std::ifstream in(file("run.json"));
  const auto told = nlohmann::json::parse(in, nullptr, false);
  std::cout << "starved: " << last.off_um() << " um off the circle, contour error until then " << told["contour_um"]
            << " um at most\n";
  EXPECT_LT(told["contour_um"], 12.0) << "rows that are lost are no error";
  EXPECT_EQ(told["stopped_because"], "starved");
  EXPECT_TRUE(last.stands);
  EXPECT_TRUE(last.is_on) << "a path that starves is no fault";
  EXPECT_LT(last.off_um(), 10.0);
}

INSTANTIATE_TEST_SUITE_P(Hidapi, UsbPath, testing::Values(host::HidBackend::hidraw),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
