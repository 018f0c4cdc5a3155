// axistool run at a board of two axes that the guest has on its USB: the paper's circle, and hosts that die or send
// nothing in the middle of an arc. The same for every board.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <thread>

#include "firmware/core/supervision/supervisor_state.hpp"
#include "host/device/board_client.hpp"
#include "host/model/model_file.hpp"
#include "tests/child.hpp"
#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace guest_test {

using namespace std::chrono_literals;

/// Both axes are the drive of `model`.
class PathBench {
 public:
  PathBench(std::string serial, host::HidBackend backend, std::string model)
      : serial_(std::move(serial)), backend_(backend), model_(std::move(model)) {}

  /// Four turns of the paper's circle, at 170 mm/s: the noise of the sensors differs from run to run, and four turns of
  /// it by less than 1 %.
  void follow_circle() const {
    fit(kPatient);
    const std::string text = "F10200 G3 X0 Y0 I35 J0\nG3 X0 Y0 I35 J0\nG3 X0 Y0 I35 J0\nG3 X0 Y0 I35 J0\nM2\n";
    const ProgramRun done = run("run " + program("circle.ngc", text) + " --yes --json -", "2>/dev/null");
    ASSERT_EQ(done.exit_code, 0) << done.output;
    const auto by_usb = nlohmann::json::parse(done.output);
    EXPECT_EQ(by_usb["stopped_because"], "completed");
    EXPECT_EQ(by_usb["lost_rows"], 0);
    const double rms_um = by_usb["contour_rms_um"];
    const double alone_um = contour_rms_in_process(host::read_model(model_), {file("x.toml"), file("y.toml")}, text);
    std::cout << "contour error by USB " << rms_um << " um rms, " << by_usb["contour_um"] << " at most; in one process "
              << alone_um << " rms\n";
    EXPECT_NEAR(rms_um, alone_um, 0.05 * alone_um);
    EXPECT_GT(rms_um, 0.3) << "an encoder of 2.4 um cannot show a smaller error";
  }

  /// After 2 s without heartbeat the host counts as lost; the ramp from 20 mm/s takes less than 0.5 s.
  void kill_host() const {
    fit("host.timeout=2");
    auto host = start_long_arc();
    await_motion();
    ASSERT_FALSE(place().stands);
    const Place before = place();
    ASSERT_GT(before.ahead_s, 3.0) << "otherwise the nodes end before the heartbeat times out";
    host->kill();
    const auto killed = Clock::now();
    Place last = place();
    while (!last.stands && Clock::now() - killed < 60s) last = place();
    const double waited_s = std::chrono::duration<double>(Clock::now() - killed).count();
    const double passed_mm =
        kRadius_mm * std::abs(std::remainder(last.turned() - before.turned(), 2.0 * std::numbers::pi));
    std::cout << "stands " << waited_s << " s and " << passed_mm << " mm after the host's end, " << last.off_um()
              << " um off the circle\n";
    EXPECT_TRUE(last.stands);
    EXPECT_EQ(last.end, firmware::PathEnd::host_lost) << "1: completed, 2: requested, 3: starved";
    EXPECT_LT(passed_mm, 20.0 * 3.0) << "at 20 mm/s, by the board's own time";
    EXPECT_LT(last.off_um(), 10.0);
    EXPECT_THAT(run("faults").output, testing::HasSubstr("host_heartbeat_lost"));
  }

  /// The host pauses for longer than the nodes last, but for less than the board's time-out.
  void starve() const {
    fit(kPatient);
    auto host = start_long_arc();
    await_motion();
    host->pause();
    const auto paused = Clock::now();
    while (!place().stands && Clock::now() - paused < 90s) std::this_thread::sleep_for(20ms);
    const Place last = place();
    host->go_on();
    host->wait();
    std::ifstream in(file("run.json"));
    const auto told = nlohmann::json::parse(in, nullptr, false);
    std::cout << "starved: " << last.off_um() << " um off the circle, contour error until then " << told["contour_um"]
              << " um at most\n";
    EXPECT_LT(told["contour_um"], 12.0) << "lost rows must not count as contour error";
    EXPECT_EQ(told["stopped_because"], "starved");
    EXPECT_TRUE(last.stands);
    EXPECT_TRUE(last.is_on) << "a path without nodes stops without a fault";
    EXPECT_LT(last.off_um(), 10.0);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kCount_mm = 0.00244140625, kRadius_mm = 35.0;
  static constexpr const char* kPatient =
      "host.timeout=10";  // longer than the eight seconds of nodes that a board stores

  std::string file(const char* name) const { return folder_.path(name); }
  std::string program(const char* name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  ProgramRun run(const std::string& arguments, const char* streams = "2>&1") const {
    return run_program("AXIS_PATIENCE=30 AXISTOOL_HIDAPI=" + std::string(host::name_of(backend_)) +
                           " timeout 240 " AXISTOOL_PROGRAM " " + arguments + " --device usb:" + serial_,
                       streams);
  }

  /// Sets a design on both axes, which have the same drive; the present positions become home.
  void fit(const std::string& more) const {
    ASSERT_EQ(run_axistool("design " + model_ + " -o " + file("x.toml")).exit_code, 0);
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
                                                            "AXIS_PATIENCE=30 exec " AXISTOOL_PROGRAM " run " + arc +
                                                                " --yes --device usb:" + serial_ + " --json " +
                                                                file("run.json") + " 2>/dev/null"});
  }

  struct Place {
    double x_mm = 0.0, y_mm = 0.0;
    bool stands = false, is_on = false;
    double ahead_s = 0.0;  ///< duration of the nodes on the board
    firmware::PathEnd end = firmware::PathEnd::none;
    double turned() const { return std::atan2(y_mm, x_mm - kRadius_mm); }
    double off_um() const { return 1e3 * std::abs(std::hypot(x_mm - kRadius_mm, y_mm) - kRadius_mm); }
  };
  Place place() const {
    host::BoardClient board(host::open_usb_board(serial_, host::hid_library(backend_)), 30s);
    const host::BoardState state = board.status();
    const firmware::PathStatePayload path = board.path_state();
    Place place{static_cast<double>(state.axis[0].counts()) * kCount_mm,
                static_cast<double>(state.axis[1].counts()) * kCount_mm,
                true,
                false,
                path.ahead * 1e-3,
                static_cast<firmware::PathEnd>(path.end)};
    for (int axis = 0; axis < 2; ++axis) {
      place.stands = place.stands && (state.axis[axis].flags & firmware::kAxisAtRest) != 0;
      place.is_on = place.is_on || state.axis[axis].state == static_cast<int>(firmware::SupervisorState::enabled);
    }
    return place;
  }
  /// Waits until the axes have moved half a radius along the arc and the host is well ahead.
  void await_motion() const {
    for (int tries = 0; tries < 400; ++tries) {
      const Place at = place();
      if (std::abs(at.y_mm) > 0.5 * kRadius_mm && at.ahead_s > 3.5) return;
      std::this_thread::sleep_for(20ms);
    }
  }

  std::string serial_;
  host::HidBackend backend_;
  std::string model_;
  TemporaryFolder folder_;
};

}  // namespace guest_test
