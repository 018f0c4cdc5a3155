// Boot code and two images in the emulator: an update, its trial, the old image's return.
#include <gtest/gtest.h>

#include "tests/target/qemu.hpp"

namespace {

using target_test::Qemu;

class BootCode : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"update-boot", "update-1", "update-2"}) {
      const std::string why = target_test::obstacle(name);
      if (!why.empty()) GTEST_SKIP() << why;
    }
    board = std::make_unique<Qemu>("mps2-an386", target_test::image("update-boot"), testing::TempDir(), options());
    board->read_until("image 1 runs\n");
    ask("b", "blank\n");
    ask("r", "image 1 runs\n");
  }
  void TearDown() override {
    if (!board) return;
    board->send("q");
    EXPECT_EQ(board->wait(), 0);
  }

  /// The first program lies behind the boot code, as if it had been flashed; the second where the first one expects it.
  static std::vector<std::string> options() {
    const auto loaded = [](const char* name, const char* address) {
      auto file = target_test::image(name);
      return "loader,force-raw=on,file=" + std::filesystem::absolute(file.replace_extension(".bin")).string() +
             ",addr=" + address;
    };
    return {"-icount",
            "shift=5",
            "-serial",
            "stdio",
            "-semihosting-config",
            "enable=on,target=native",
            "-device",
            loaded("update-1", "0x4000"),
            "-device",
            loaded("update-2", "0x200000")};
  }
  void ask(const char* letter, const char* answer) {
    board->send(letter);
    board->read_until(answer);
  }

  std::unique_ptr<Qemu> board;
};

TEST_F(BootCode, StartsANewImageOnTrialAndKeepsItOnceItIsConfirmed) {
  ask("u", "taken\n");
  ask("r", "image 2 on trial\n");
  ask("c", "confirmed\n");
  ask("r", "image 2 runs\n");
  ask("r", "image 2 runs\n");
}

TEST_F(BootCode, TheOldImageReturnsWhereNobodyConfirms) {
  ask("u", "taken\n");
  ask("r", "image 2 on trial\n");
  ask("r", "image 1 runs\n");
  ask("r", "image 1 runs\n");
}

TEST_F(BootCode, AnImageThatHangsIsResetByItsWatchdog) {
  ask("u", "taken\n");
  ask("r", "image 2 on trial\n");
  ask("h", "image 1 runs\n");
}

}  // namespace
