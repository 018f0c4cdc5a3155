// The Cortex-M image, emulated, as a USB device of the guest: everything above the controller's driver is the target's
// own code, from the reports to the parameter store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "firmware/app/store/parameter_store.hpp"
#include "host/device/board_client.hpp"
#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"
#include "tests/child.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/guest/support/path_bench.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/run_program.hpp"

namespace {

using namespace std::chrono_literals;
using host::BoardClient;
using testing::HasSubstr;

/// The board, which is emulated beside the guest: tests/guest/with_cortex_m.sh.
class CortexM : public testing::TestWithParam<host::HidBackend> {
 protected:
  static void SetUpTestSuite() {
    if (!guest_test::in_guest() || bridge) return;
    for (const auto& entry : std::filesystem::directory_iterator("/dev"))
      if (entry.path().filename().string().rfind("vport", 0) == 0)
        bridge.emplace(std::vector<std::string>{CORTEX_BRIDGE, entry.path(), "CORTEX"});
  }

  void SetUp() override {
    if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/with_cortex_m.sh";
    ASSERT_TRUE(bridge) << "no board is beside the guest";
    ASSERT_TRUE(guest_test::boards_become(1, library(), 30s));
  }

  const host::HidLibrary& library() const { return host::hid_library(GetParam()); }
  /// Long time-outs, because the board's emulator has a separate, possibly slower clock.
  BoardClient client() const { return BoardClient(host::open_usb_board("CORTEX", library()), 30s); }

  /// A reset disconnects the board briefly; until then the board may still answer from before the reset.
  void restart() const {
    std::uint32_t resets = 0;
    {
      BoardClient board = client();
      resets = board.status().resets;
      board.restart();
    }
    const auto has_restarted = [&] {
      try {
        return client().status().resets == resets + 1;
      } catch (const host::Failure&) {
        return false;
      }
    };
    for (int attempt = 0; attempt < 100; ++attempt) {
      std::this_thread::sleep_for(100ms);
      if (has_restarted()) return;
    }
    FAIL() << "the board did not come back";
  }

  ProgramRun run(const std::string& arguments, const std::string& streams = "2>&1") const {
    return run_program("AXIS_PATIENCE=30 AXISTOOL_HIDAPI=" + std::string(host::name_of(GetParam())) + " timeout 120 " +
                           AXISTOOL_PROGRAM + " " + arguments,
                       streams);
  }

  TemporaryFolder folder_;
  static std::optional<Child> bridge;  ///< for all tests: the board stays connected
};
std::optional<Child> CortexM::bridge;

TEST_P(CortexM, KeepsParametersOverAReset) {
  // A different set for each back end, so that the second does not find its values already set.
  firmware::ParameterValues wanted = firmware_test::paper_values();
  if (GetParam() == host::HidBackend::libusb) firmware_test::fit_axis(wanted, "y", firmware_test::kPaperY);
  {
    BoardClient board = client();
    const host::BoardState before = board.status();
    const firmware::IdentityPayload identity = board.identify();
    EXPECT_STREQ(identity.board.data(), "emulated");
    EXPECT_EQ(identity.schema_hash, firmware::kSchemaHash);
    EXPECT_FALSE(board.read_values() == wanted);
    board.write_values(wanted);
    EXPECT_TRUE(board.read_values() == wanted);
    board.save();
    EXPECT_EQ(board.status().store_sequence, before.store_sequence + 1);
  }
  ASSERT_NO_FATAL_FAILURE(restart());
  BoardClient board = client();
  EXPECT_EQ(board.status().store_state, static_cast<std::uint8_t>(firmware::StoreState::loaded));
  EXPECT_TRUE(board.read_values() == wanted);
}

TEST_P(CortexM, ServesTheCommands) {
  const std::string params = folder_.path("params.toml"), record = folder_.path("idle.csv");
  ASSERT_EQ(run("design " AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml -o " + params).exit_code, 0);
  EXPECT_THAT(run("list").output, HasSubstr("usb:CORTEX"));
  const ProgramRun info = run("info --json -", "2>/dev/null");
  ASSERT_EQ(info.exit_code, 0) << info.output;
  EXPECT_EQ(nlohmann::json::parse(info.output)["board"], "emulated");
  const ProgramRun set = run("set-params " + params);
  ASSERT_EQ(set.exit_code, 0) << set.output;
  ASSERT_EQ(run("save").exit_code, 0);
  ASSERT_NO_FATAL_FAILURE(restart());
  EXPECT_THAT(run("get-params x.feedback.k1").output, HasSubstr("x.feedback.k1"));
  EXPECT_EQ(run("diff-params " + params).exit_code, 0);
  ASSERT_EQ(run("set-params x.feedback.k1=20").exit_code, 0);
  EXPECT_EQ(run("diff-params " + params).exit_code, 1);
  const ProgramRun capture = run("capture -o " + record + " --for 10");
  ASSERT_EQ(capture.exit_code, 0) << capture.output;
  EXPECT_EQ(host::read_record(record).size(), 10000u) << "at 1 kHz";
}

/// Paths on the board, whose image also simulates the drives, with the target's float arithmetic and interrupt;
/// compared with the host's simulation of the same drives.
class CortexMPath : public CortexM {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(CortexM::SetUp());
    if (!IsSkipped()) restart();  // without the faults of the test before
  }

  guest_test::PathBench bench_{"CORTEX", GetParam(), AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml"};
};

TEST_P(CortexMPath, FollowsTheCircleAsNearAsInOneProcess) { bench_.follow_circle(); }
TEST_P(CortexMPath, AKilledHostLeavesAxesThatStandOnThePath) { bench_.kill_host(); }
TEST_P(CortexMPath, AStarvedPathEndsOnThePath) { bench_.starve(); }

INSTANTIATE_TEST_SUITE_P(Hidapi, CortexMPath, testing::Values(host::HidBackend::hidraw),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

INSTANTIATE_TEST_SUITE_P(Hidapi, CortexM, testing::Values(host::HidBackend::hidraw, host::HidBackend::libusb),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
