// axistool run with a simulated board of two axes on Linux' own USB stack. Runs in the guest, which has a deterministic
// clock, so that load on the computer has no effect.
#include <gtest/gtest.h>

#include <memory>

#include "tests/guest/support/guest_boards.hpp"
#include "tests/guest/support/path_bench.hpp"

namespace {

using namespace std::chrono_literals;

const std::string kModel = AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml";

class UsbPath : public testing::TestWithParam<host::HidBackend> {
 protected:
  void SetUp() override {
    if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/run.sh";
    ASSERT_TRUE(guest_test::boards_become(0, library(), 20s)) << "the board of the test before";
    board_ = std::make_unique<Child>(std::vector<std::string>{AXISTOOL_PROGRAM, "sim", "--usb", "--serial", "BENCH",
                                                              "--flash", folder_.path("usb.flash"), "--x", kModel,
                                                              "--y", kModel});
    ASSERT_TRUE(guest_test::boards_become(1, library(), 20s));
  }
  const host::HidLibrary& library() const { return host::hid_library(GetParam()); }

  TemporaryFolder folder_;
  std::unique_ptr<Child> board_;
  guest_test::PathBench bench_{"BENCH", GetParam(), kModel};
};

TEST_P(UsbPath, FollowsTheCircleAsNearAsWithoutUsb) { bench_.follow_circle(); }
TEST_P(UsbPath, AKilledHostLeavesAxesThatStandOnThePath) { bench_.kill_host(); }
TEST_P(UsbPath, AStarvedPathEndsOnThePath) { bench_.starve(); }

INSTANTIATE_TEST_SUITE_P(Hidapi, UsbPath, testing::Values(host::HidBackend::hidraw),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
