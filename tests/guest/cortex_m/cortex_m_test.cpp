// The Cortex-M image, emulated, as a USB device of the guest: everything above the controller's driver is the target's
// own code, from the reports to the parameter store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "firmware/app/store/parameter_store.hpp"
#include "host/device/board_client.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/guest/support/child.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/guest/support/path_in_process.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/run_program.hpp"

namespace {

using namespace std::chrono_literals;
using guest_test::Child;
using host::BoardClient;
using testing::HasSubstr;

/// The board beside the guest: tests/guest/with_cortex_m.sh.
class CortexM : public testing::TestWithParam<host::HidBackend> {
 protected:
  static void SetUpTestSuite() {
    if (!guest_test::in_guest()) return;
    for (const auto& entry : std::filesystem::directory_iterator("/dev"))
      if (entry.path().filename().string().rfind("vport", 0) == 0)
        bridge.emplace(std::vector<std::string>{CORTEX_BRIDGE, entry.path(), "CORTEX"});
  }
  static void TearDownTestSuite() { bridge.reset(); }

  void SetUp() override {
    if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/with_cortex_m.sh";
    ASSERT_TRUE(bridge) << "no board is beside the guest";
    ASSERT_TRUE(guest_test::boards_become(1, library(), 30s));
  }

  const host::HidLibrary& library() const { return host::hid_library(GetParam()); }
  /// Two emulators, each with its own time: the board's may pass slowly as seen from here.
  BoardClient client() const { return BoardClient(host::open_usb_board("CORTEX", library()), 30s); }

  /// A reset takes the board off the bus for a moment; until then the board of before may still answer.
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
  static std::optional<Child> bridge;
};
std::optional<Child> CortexM::bridge;

TEST_P(CortexM, KeepsParametersOverAReset) {
  // Another set for each back end: the second must not find what it is to write.
  firmware::ParameterValues wanted = firmware_test::paper_values();
  if (GetParam() == host::HidBackend::libusb) firmware_test::fit_axis(wanted, "y", firmware_test::kPaperY);
  {
    BoardClient board = client();
    const host::BoardState before = board.status();
    const firmware::IdentityPayload identity = board.identify();
    EXPECT_STREQ(identity.board.data(), "qemu-usb");
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
  EXPECT_EQ(nlohmann::json::parse(info.output)["board"], "qemu-usb");
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

/// Four turns of the paper's circle with the drives that the image computes, against the host's simulation of the same
/// drives in one process. Run by `make cortex-circle` alone: the two emulators have two times, and where the guest's
/// passes more slowly its stream starves the board, which then stops on the path as it must.
TEST_P(CortexM, DISABLED_FollowsTheCircleAsNearAsInOneProcess) {
  const std::string model = AXIS_TEST_DATA "/drive-cases/none/case-00/model.toml";
  const std::string x = folder_.path("x.toml"), y = folder_.path("y.toml"), program = folder_.path("circle.ngc");
  ASSERT_EQ(run("design " + model + " -o " + x).exit_code, 0);
  std::ifstream in(x);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  for (std::size_t at = 0; (at = text.find("[x.", at)) != std::string::npos;) text[at + 1] = 'y';
  std::ofstream(y) << text;
  const std::string turn = "G3 X0 Y0 I35 J0\n", circle = "F10200 " + turn + turn + turn + turn + "M2\n";
  std::ofstream(program) << circle;
  ASSERT_EQ(run("set-params " + x + " host.timeout=10").exit_code, 0);
  ASSERT_EQ(run("set-params " + y).exit_code, 0);
  for (const char* axis : {"x", "y"}) ASSERT_EQ(run(std::string("home ") + axis + " --here").exit_code, 0);
  const ProgramRun done = run("run " + program + " --yes --json -", "2>/dev/null");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const auto by_usb = nlohmann::json::parse(done.output);
  EXPECT_EQ(by_usb["stopped_because"], "completed");
  EXPECT_EQ(by_usb["lost_rows"], 0);
  const double rms_um = by_usb["contour_rms_um"];
  const double alone_um = guest_test::contour_rms_in_process(host::read_model(model), {x, y}, circle);
  std::cout << "contour error of the emulated board " << rms_um << " um rms; in one process " << alone_um << "\n";
  EXPECT_NEAR(rms_um, alone_um, 0.05 * alone_um);
}

INSTANTIATE_TEST_SUITE_P(Hidapi, CortexM, testing::Values(host::HidBackend::hidraw, host::HidBackend::libusb),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
