// An axis commissioned over Linux' own USB stack, in one command. Runs in the guest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/model/model_file.hpp"
#include "tests/child.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/run_program.hpp"

namespace {

using namespace std::chrono_literals;
using testing::Contains;

/// The board is a separate process behind the kernel's USB stack, and its axis moves in the guest's time, independent
/// of the host's speed. Catches a step of commissioning that works only if board and host take turns.
TEST(UsbCommission, FindsWhatCogsAndMakesItBetter) {
  if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/run.sh";
  const TemporaryFolder folder;
  const std::string machine = COMMISSION_MACHINE, sheet = folder.path("sheet.toml"), found = folder.path("found");
  sim::DriveDescription drive = host::read_model(machine);
  drive.effects.clear();
  host::write_model(drive, sheet);
  Child board({AXISTOOL_PROGRAM, "sim", "--usb", "--serial", "BENCH", "--forget", "--axes", "1", "--x", machine});
  ASSERT_TRUE(guest_test::boards_become(1, host::hid_library(host::HidBackend::hidraw), 20s));
  // Its steps show on the console while it runs.
  const ProgramRun run =
      run_program("AXISTOOL_HIDAPI=hidraw " AXISTOOL_PROGRAM " commission x --yes -o " + found + " --drive " + sheet +
                      " --home switch --box travel=400,speed=800,volts=5,time=360",
                  ">&2");
  ASSERT_EQ(run.exit_code, 0);
  const auto state = nlohmann::json::parse(std::ifstream(found + "/commission.json"));
  EXPECT_THAT(state.at("verdict").at("effects"), Contains("cogging"));
  EXPECT_EQ(state.at("kept"), "new");
  EXPECT_LT(state.at("following_error_um").at("after"), state.at("following_error_um").at("before"));
  EXPECT_TRUE(std::filesystem::exists(found + "/page.html"));
  std::printf("motion %s s, following error %s\n", state.at("motion_s").dump().c_str(),
              state.at("following_error_um").dump().c_str());
}

}  // namespace
