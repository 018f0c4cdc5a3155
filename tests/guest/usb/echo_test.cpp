// The connection to a board over Linux' USB and HID stack, with both back ends of hidapi. Runs in the guest.
#include <grp.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "host/exit_codes.hpp"
#include "host/link/udev_rule.hpp"
#include "host/link/usb_boards.hpp"
#include "tests/child.hpp"
#include "tests/guest/echo_board/echo_report.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/run_program.hpp"

namespace {

using namespace std::chrono_literals;
using host::find_usb_boards;
using host::HidBackend;
using host::open_usb_board;

class Usb : public testing::TestWithParam<HidBackend> {
 protected:
  void SetUp() override {
    if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/run.sh";
    wait_for_boards(0);  // those of the test before
  }

  const host::HidLibrary& library() const { return host::hid_library(GetParam()); }

  void wait_for_boards(std::size_t count) const {
    ASSERT_TRUE(guest_test::boards_become(count, library(), 10s))
        << "there are " << find_usb_boards(library()).size() << " boards, not " << count;
  }
};

hal::HidReport report_of(std::size_t seed) {
  hal::HidReport report{};
  for (std::size_t i = 0; i < report.size(); ++i) report[i] = static_cast<std::byte>(seed + 3 * i);
  return report;
}

TEST_P(Usb, FindsTheBoardByItsNamesAndExchangesReports) {
  const Child board({ECHO_BOARD, "00FEDCBA0123456789ABCDEF"});
  wait_for_boards(1);
  const auto boards = find_usb_boards(library());
  ASSERT_EQ(boards.size(), 1u);
  EXPECT_EQ(boards[0].serial_number, "00FEDCBA0123456789ABCDEF");
  EXPECT_EQ(boards[0].product, "Axis board");
  const auto link = open_usb_board("", library());
  EXPECT_EQ(link->name(), "usb:00FEDCBA0123456789ABCDEF");
  for (unsigned i = 0; i < 300; ++i) {
    link->send(report_of(i));
    const auto answer = link->receive(2s);
    ASSERT_TRUE(answer) << i;
    ASSERT_EQ(*answer, echo_board::inverted(report_of(i)));
  }
  EXPECT_FALSE(link->receive(20ms)) << "the board sends nothing without a request";
}

TEST_P(Usb, CarriesAThousandReportsASecondWithoutLoss) {
  constexpr std::uint32_t kReports = 1000;
  const Child board({ECHO_BOARD, "STREAM"});
  wait_for_boards(1);
  const auto link = open_usb_board("STREAM", library());
  link->send(echo_board::stream_request(kReports));
  std::this_thread::sleep_for(500ms);  // a program that is busy meanwhile loses no report
  for (std::uint32_t i = 0; i < kReports; ++i) {
    const auto report = link->receive(2s);
    ASSERT_TRUE(report) << i;
    ASSERT_EQ(echo_board::number_of(*report), i);
  }
}

TEST_P(Usb, OutlivesAStall) {
  const Child board({ECHO_BOARD, "STALL"});
  wait_for_boards(1);
  const auto boards = find_usb_boards(library());
  hid_device* device = library().open_path(boards.at(0).path.c_str());
  ASSERT_NE(device, nullptr);
  std::array<unsigned char, 65> feature{};
  EXPECT_LT(library().send_feature_report(device, feature.data(), feature.size()), 0) << "there is no such report";
  std::array<unsigned char, 65> out{};
  out[1] = 42;
  EXPECT_EQ(library().write(device, out.data(), out.size()), 65);
  std::array<unsigned char, 64> in{};
  EXPECT_EQ(library().read_timeout(device, in.data(), in.size(), 2000), 64);
  EXPECT_EQ(in[0], 0xFF - 42);
  library().close(device);
}

TEST_P(Usb, NoticesAPulledPlug) {
  Child board({ECHO_BOARD, "PLUG"});
  wait_for_boards(1);
  const auto link = open_usb_board("", library());
  link->send(report_of(1));
  ASSERT_TRUE(link->receive(2s));
  std::thread pull([&] {
    std::this_thread::sleep_for(100ms);
    board.kill();
  });
  try {
    const auto report = link->receive(10s);
    ADD_FAILURE() << "no failure; " << (report ? "a report" : "no report");
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::no_such_device);
  }
  pull.join();
  wait_for_boards(0);
  EXPECT_THROW(open_usb_board("", library()), host::Failure);
}

TEST_P(Usb, TellsTwoBoardsApart) {
  const Child first({ECHO_BOARD, "FIRST"});
  wait_for_boards(1);
  const Child second({ECHO_BOARD, "SECOND"});
  wait_for_boards(2);
  const auto to_first = open_usb_board("FIRST", library());
  const auto to_second = open_usb_board("SECOND", library());
  to_first->send(report_of(1));
  to_second->send(report_of(2));
  EXPECT_EQ(to_first->receive(2s), echo_board::inverted(report_of(1)));
  EXPECT_EQ(to_second->receive(2s), echo_board::inverted(report_of(2)));
  for (const std::string wanted : {"", "THIRD"}) {
    try {
      open_usb_board(wanted, library());
      ADD_FAILURE() << "opened one of two";
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::no_such_device);
      EXPECT_NE(std::string(failure.what()).find("usb:FIRST"), std::string::npos) << failure.what();
      EXPECT_NE(std::string(failure.what()).find("usb:SECOND"), std::string::npos) << failure.what();
    }
  }
}

/// Opens the board as an unprivileged user in the named groups; returns the exit code of ExitCode.
int open_as_user(const host::HidLibrary& library, const char* groups, std::string& message) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    constexpr gid_t kNobody = 65534;
    const group* plugdev = getgrnam(groups);
    const gid_t member = plugdev != nullptr ? plugdev->gr_gid : kNobody;
    if (setgroups(1, &member) != 0 || setgid(kNobody) != 0 || setuid(kNobody) != 0) _exit(99);
    try {
      const auto link = open_usb_board("", library);
      link->send(report_of(1));
      _exit(link->receive(2s) == echo_board::inverted(report_of(1)) ? 0 : 98);
    } catch (const host::Failure& failure) {
      const std::string text = failure.what();
      _exit(write(pipe_ends[1], text.data(), text.size()) < 0 ? 97 : static_cast<int>(failure.code));
    }
  }
  close(pipe_ends[1]);
  std::array<char, 4096> buffer{};
  const ssize_t size = read(pipe_ends[0], buffer.data(), buffer.size());
  message.assign(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_P(Usb, OpensForAUserOnceTheRuleIsInstalled) {
  const std::filesystem::path rules = "/run/udev/rules.d/70-axis.rules";
  std::filesystem::remove(rules);
  ASSERT_EQ(run_program("udevadm control --reload").exit_code, 0);
  std::string message;
  {
    const Child board({ECHO_BOARD, "RULE"});
    wait_for_boards(1);
    EXPECT_EQ(open_as_user(library(), "plugdev", message), 4) << message;
    EXPECT_NE(message.find(host::udev_rule()), std::string::npos) << message;
    EXPECT_NE(message.find(host::kInstallUdevRule), std::string::npos) << message;
  }
  wait_for_boards(0);
  std::filesystem::create_directories(rules.parent_path());
  std::ofstream(rules) << host::udev_rule();
  ASSERT_EQ(run_program("udevadm control --reload").exit_code, 0);
  const Child board({ECHO_BOARD, "RULE"});
  wait_for_boards(1);
  ASSERT_EQ(run_program("udevadm settle --timeout=20").exit_code, 0);
  EXPECT_EQ(open_as_user(library(), "plugdev", message), 0) << message;
  EXPECT_EQ(open_as_user(library(), "nogroup", message), 4) << "only the group of the rule has access: " << message;
}

INSTANTIATE_TEST_SUITE_P(Hidapi, Usb, testing::Values(HidBackend::hidraw, HidBackend::libusb),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
