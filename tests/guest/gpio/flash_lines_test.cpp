// `axistool flash` on a real GPIO chip: levels and times of BOOT0 and NRST. Runs in the guest, with both versions of
// libgpiod.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "hal/linux/gpio_line.hpp"
#include "tests/guest/gpio/cp2112.hpp"
#include "tests/host/device/sample_image.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/run_program.hpp"

namespace {

using namespace std::chrono_literals;
using guest_test::Cp2112;

constexpr unsigned kBoot0 = 2, kReset = 5;
constexpr std::uint8_t kResetPulledUp = 1u << kReset;

/// A fake dfu-util that finds a board, keeps its input, and records the times of its calls.
constexpr const char* kDfuUtil = R"(#!/bin/bash
here=$(dirname "$0")
echo "$EPOCHREALTIME $*" >>"$here/calls"
[ ! -e "$here/no-board" ] || { echo "No DFU capable USB device available"; exit 74; }
what=flash
[ -e "$here/options" ] || printf '\343\252\034\125\0\0\0\0\377\17\0\360\0\0\0\0' >"$here/options"
while [ $# -gt 0 ]; do
  case $1 in
    -a) [ "$2" = 0 ] || what=options ;;
    -l) echo 'Found DFU: [0483:df11] name="@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg"' ;;
    -D) cp "$2" "$here/$what" ;;
    -U) [ ! -e "$2" ] || exit 74; cp "$here/$what" "$2" ;;
  esac
  shift
done
)";

struct Program {
  const char* name;
  const char* path;
};
void PrintTo(const Program& program, std::ostream* out) { *out << program.path; }

class FlashLines : public testing::TestWithParam<Program> {
 protected:
  void SetUp() override {
    if (std::getenv("AXIS_GUEST") == nullptr) GTEST_SKIP() << "runs in the guest: tests/guest/run.sh";
    if (*GetParam().path == '\0') GTEST_SKIP() << "libgpiod 2.x of Debian 13 could not be fetched";
    image_ = folder_.write("image.bin", flash_text("axis-f405"));
    for (const std::string& path : {folder_.path(""), folder_.write("dfu-util", kDfuUtil)})
      std::filesystem::permissions(path, std::filesystem::perms(0755));  // for a user without rights too
  }

  ProgramRun flash(const std::string& before = "") const {
    return run_program("PATH=" + folder_.path("") + ":$PATH " + before + " " + GetParam().path + " flash " + image_ +
                       " --gpiochip " + chip_.chip().string() + " --boot0 2 --reset 5");
  }

  /// When dfu-util was called, oldest first.
  std::vector<std::chrono::system_clock::time_point> calls() const {
    std::ifstream file(folder_.path("calls"));
    std::vector<std::chrono::system_clock::time_point> times;
    for (std::string line; std::getline(file, line);)
      times.emplace_back(std::chrono::duration_cast<std::chrono::system_clock::duration>(
          std::chrono::duration<double>(std::stod(line))));
    return times;
  }

  TemporaryFolder folder_;
  std::string image_;
  Cp2112 chip_{kResetPulledUp};
};

std::string text(const std::vector<Cp2112::Edge>& edges) {
  std::string result;
  for (const Cp2112::Edge& edge : edges)
    result += std::string(edge.line == kBoot0   ? "BOOT0"
                          : edge.line == kReset ? "NRST"
                                                : "other") +
              (edge.level ? " high, " : " low, ");
  return result;
}

constexpr const char* kWholeSequence = "BOOT0 high, NRST low, NRST high, BOOT0 low, NRST low, NRST high, ";

TEST_P(FlashLines, RiseAndFallInOrderAndInTime) {
  const ProgramRun run = flash();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto edges = chip_.edges();
  ASSERT_EQ(text(edges), kWholeSequence);
  EXPECT_TRUE(chip_.drives(kBoot0));
  EXPECT_FALSE(chip_.drives(kReset)) << "open drain: whoever else pulls NRST low, a probe or the watchdog, must win";
  const auto dfu_util = calls();
  ASSERT_EQ(dfu_util.size(), 4u) << "list, option bytes, write, read back";
  // STM32F405 datasheet, table 47: a reset pulse of 20 us; with the board's capacitor at NRST, 1 ms. AN2606: the
  // bootloader takes some 100 ms to its USB connection.
  EXPECT_GE(edges[1].at - edges[0].at, 1ms) << "BOOT0 is stable before reset";
  EXPECT_GE(edges[2].at - edges[1].at, 10ms) << "reset pulse";
  EXPECT_GE(dfu_util[0] - edges[2].at, 100ms) << "the bootloader needs time";
  EXPECT_GE(edges[3].at, dfu_util[3]) << "BOOT0 falls after the last use of the bootloader";
  EXPECT_GE(edges[4].at - edges[3].at, 1ms) << "BOOT0 is stable before reset";
  EXPECT_GE(edges[5].at - edges[4].at, 10ms) << "reset pulse";
}

TEST_P(FlashLines, LetTheBoardRunWhenItsBootloaderIsNotFound) {
  folder_.write("no-board", "");
  const ProgramRun run = flash();
  EXPECT_EQ(run.exit_code, 3) << run.output;
  EXPECT_NE(run.output.find("BOOT0 high during reset"), std::string::npos) << run.output;
  EXPECT_EQ(text(chip_.edges()), kWholeSequence);
}

TEST_P(FlashLines, AreLeftAloneWhereAnotherProgramHoldsOne) {
  const hal::linux_gpio::OutputLine held(chip_.chip(), kReset, hal::linux_gpio::Drive::open_drain, true);
  const ProgramRun run = flash();
  EXPECT_EQ(run.exit_code, 3) << run.output;
  EXPECT_NE(run.output.find("line 5"), std::string::npos) << run.output;
  EXPECT_EQ(text(chip_.edges()), "");
}

TEST_P(FlashLines, NeedPermission) {
  const ProgramRun run = flash("setpriv --reuid=65534 --regid=65534 --clear-groups");
  EXPECT_EQ(run.exit_code, 4) << run.output;
  EXPECT_NE(run.output.find("group that owns the GPIO chip"), std::string::npos) << run.output;
  EXPECT_EQ(text(chip_.edges()), "");
}

TEST_P(FlashLines, MayVanishInTheMiddle) {
  std::thread unplug([this] {
    for (int i = 0; i < 1000 && chip_.edges().size() < 3; ++i) std::this_thread::sleep_for(10ms);
    chip_.unplug();
  });
  const std::string chip = chip_.chip();
  const ProgramRun run = flash();
  unplug.join();
  EXPECT_EQ(run.exit_code, 3) << run.output;
  EXPECT_NE(run.output.find(chip), std::string::npos) << run.output;
}

INSTANTIATE_TEST_SUITE_P(Libgpiod, FlashLines,
                         testing::Values(Program{"installed", AXISTOOL_PROGRAM},
                                         Program{"version2", AXISTOOL_GPIOD2_PROGRAM}),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
