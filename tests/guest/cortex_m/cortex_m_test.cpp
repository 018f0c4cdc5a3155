// The Cortex-M image, emulated, as a USB device of the guest: everything above the controller's driver is the target's
// own code, from the reports to the parameter store.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "firmware/app/store/parameter_store.hpp"
#include "host/device/board_client.hpp"
#include "host/exit_codes.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/guest/support/child.hpp"
#include "tests/guest/support/guest_boards.hpp"

namespace {

using namespace std::chrono_literals;
using guest_test::Child;
using host::BoardClient;

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

  static std::optional<Child> bridge;
};
std::optional<Child> CortexM::bridge;

TEST_P(CortexM, KeepsParametersOverAResetAndCountsEveryRow) {
  // Another set for each back end: the second must not find what it is to write.
  firmware::ParameterValues wanted = firmware_test::paper_values();
  if (GetParam() == host::HidBackend::libusb) firmware_test::fit_axis(wanted, "y", firmware_test::kPaperY);
  firmware::StatusPayload before;
  {
    BoardClient board = client();
    before = board.status();
    const firmware::IdentityPayload identity = board.identify();
    EXPECT_STREQ(identity.board.data(), "qemu-usb");
    EXPECT_EQ(identity.schema_hash, firmware::kSchemaHash);
    EXPECT_FALSE(board.read_values() == wanted);
    board.write_values(wanted);
    EXPECT_TRUE(board.read_values() == wanted);
    board.save();
    EXPECT_EQ(board.status().store_sequence, before.store_sequence + 1);

    // The emulated board keeps real time, this computer may not keep up with it: then rows are dropped, but counted.
    constexpr std::size_t kWords = 3;  // x: counts and speed; y: counts
    constexpr std::uint32_t kRows = 2000;
    board.start_capture({{0x0042, 0x0002}, 1, 0});
    std::uint32_t received = 0, last = 0;
    const auto take = [&](const BoardClient::Samples& samples) {
      ASSERT_GE(samples.first_row, last);
      received += static_cast<std::uint32_t>(samples.words.size() / kWords);
      last = samples.first_row + static_cast<std::uint32_t>(samples.words.size() / kWords);
    };
    while (last < kRows) {
      const auto samples = board.next_samples(30s);
      ASSERT_TRUE(samples) << "after row " << last;
      take(*samples);
    }
    const firmware::CaptureReply counted = board.stop_capture();
    while (received + counted.dropped < counted.rows) {
      const auto samples = board.next_samples(30s);
      ASSERT_TRUE(samples) << received << " of " << counted.rows << " rows";
      take(*samples);
    }
    EXPECT_EQ(received + counted.dropped, counted.rows) << "a row is neither here nor counted as lost";
    std::cout << counted.rows << " rows at 1 kHz, " << counted.dropped << " dropped\n";
    board.restart();
  }
  // A reset takes the board off the bus for a moment; until then the board of before may still answer.
  const auto has_restarted = [&] {
    try {
      return client().status().resets == before.resets + 1;
    } catch (const host::Failure&) {
      return false;
    }
  };
  bool restarted = false;
  for (int attempt = 0; attempt < 100 && !restarted; ++attempt) {
    std::this_thread::sleep_for(100ms);
    restarted = has_restarted();
  }
  ASSERT_TRUE(restarted);
  BoardClient board = client();
  EXPECT_EQ(board.status().store_state, static_cast<std::uint8_t>(firmware::StoreState::loaded));
  EXPECT_TRUE(board.read_values() == wanted);
}

INSTANTIATE_TEST_SUITE_P(Hidapi, CortexM, testing::Values(host::HidBackend::hidraw, host::HidBackend::libusb),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
