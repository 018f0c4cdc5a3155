// axistool's commands with a simulated board on Linux' own USB stack, by both of hidapi's back ends. Runs in the guest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/record/read_record.hpp"
#include "tests/child.hpp"
#include "tests/guest/support/guest_boards.hpp"
#include "tests/host/axistool/run_workflow.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/run_program.hpp"

namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kCase = AXIS_TEST_DATA "/drive-cases/none/case-00";

class UsbCommands : public testing::TestWithParam<host::HidBackend> {
 protected:
  void SetUp() override {
    if (!guest_test::in_guest()) GTEST_SKIP() << "runs in the guest: tests/guest/run.sh";
    expect_boards(0);  // those of the test before
    std::filesystem::permissions(folder_.path(""), std::filesystem::perms(0755));
    plug_in();
  }

  void expect_boards(std::size_t count) const {
    ASSERT_TRUE(guest_test::boards_become(count, host::hid_library(GetParam()), 20s));
  }

  std::unique_ptr<Child> start_board(const std::string& serial_number) const {
    return std::make_unique<Child>(std::vector<std::string>{AXISTOOL_PROGRAM, "sim", "--usb", "--serial", serial_number,
                                                            "--flash", folder_.path(serial_number + ".flash"), "--x",
                                                            kCase + "/model.toml"});
  }
  /// Connects the board with the flash contents of its last disconnection.
  void plug_in() {
    board_ = start_board("BENCH");
    expect_boards(1);
  }
  void pull_plug() {
    board_.reset();
    expect_boards(0);
  }

  /// Runs axistool in a shell line that begins with `before`.
  ProgramRun run(const std::string& arguments, const std::string& before = "",
                 const std::string& streams = "2>&1") const {
    return run_program("AXISTOOL_HIDAPI=" + std::string(host::name_of(GetParam())) + " timeout 60 " + before + " " +
                           AXISTOOL_PROGRAM + " " + arguments,
                       streams);
  }

  std::string design() const {
    EXPECT_EQ(run("design " + kCase + "/model.toml -o " + folder_.path("params.toml")).exit_code, 0);
    return folder_.path("params.toml");
  }

  TemporaryFolder folder_;
  std::unique_ptr<Child> board_;
};

TEST_P(UsbCommands, KeepParametersOverAPowerCycle) {
  EXPECT_THAT(run("list").output, HasSubstr("usb:BENCH"));
  const ProgramRun info = run("info --json -", "", "2>/dev/null");
  ASSERT_EQ(info.exit_code, 0) << info.output;
  EXPECT_EQ(nlohmann::json::parse(info.output)["format"], "axis-board/1");
  const std::string params = design();
  const ProgramRun set = run("set-params " + params);
  ASSERT_EQ(set.exit_code, 0) << set.output;
  ASSERT_EQ(run("save").exit_code, 0);
  pull_plug();
  plug_in();
  EXPECT_THAT(run("get-params x.feedback.k1").output, HasSubstr("x.feedback.k1"));
  EXPECT_EQ(run("diff-params " + params).exit_code, 0);
  ASSERT_EQ(run("set-params x.feedback.k1=20").exit_code, 0);
  EXPECT_EQ(run("diff-params " + params).exit_code, 1);
  EXPECT_EQ(run("set-params x.kalman.k11=5.2").exit_code, 2);
}

TEST_P(UsbCommands, CaptureTenSecondsWithoutLoss) {
  const std::string record = folder_.path("idle.csv");
  const ProgramRun capture = run("capture -o " + record + " --for 10");
  ASSERT_EQ(capture.exit_code, 0) << capture.output;
  EXPECT_EQ(host::read_record(record).size(), 10000u);
}

TEST_P(UsbCommands, EndWhenThePlugIsPulledAndLeaveTheBoardIntact) {
  const std::string params = design();
  ASSERT_EQ(run("set-params " + params + " --save").exit_code, 0);
  for (const std::string& command :
       std::vector<std::string>{"list", "info", "get-params", "set-params x.feedback.k1=20", "save", "diff-params",
                                "capture -o " + folder_.path("never.csv") + " --for 60"}) {
    board_->pause();  // the command begins but cannot finish
    std::thread plug([&] {
      std::this_thread::sleep_for(400ms);
      board_->kill();
    });
    const ProgramRun ended = run(command + (command == "diff-params" ? " " + params : ""));
    plug.join();
    // `list` asks the kernel alone.
    EXPECT_THAT(ended.exit_code, command == "list" ? AnyOf(0, 3) : AnyOf(3, 7)) << command << "\n" << ended.output;
    expect_boards(0);
    plug_in();
    EXPECT_EQ(run("diff-params " + params).exit_code, 0) << "after " << command;
  }
  std::thread plug([&] {
    std::this_thread::sleep_for(2s);
    board_->kill();
  });
  const ProgramRun capture = run("capture -o " + folder_.path("never.csv") + " --for 60");
  plug.join();
  EXPECT_THAT(capture.exit_code, AnyOf(3, 7)) << capture.output;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("never.csv")));
}

TEST_P(UsbCommands, TellAUserWithoutTheRuleAndServeOneWithIt) {
  const std::string stranger = "setpriv --reuid=65534 --regid=65534 --clear-groups";
  const std::string member = "setpriv --reuid=65534 --regid=65534 --groups=$(getent group plugdev | cut -d: -f3)";
  const ProgramRun rule = run("udev-rule");
  const ProgramRun denied = run("info", stranger);
  EXPECT_EQ(denied.exit_code, 4) << denied.output;
  EXPECT_THAT(denied.output, AllOf(HasSubstr(rule.output), HasSubstr("udev-rule --install")));
  pull_plug();
  const std::filesystem::path file = "/run/udev/rules.d/70-axis.rules";
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << rule.output;
  ASSERT_EQ(run_program("udevadm control --reload").exit_code, 0);
  plug_in();
  ASSERT_EQ(run_program("udevadm settle --timeout=20").exit_code, 0);
  const ProgramRun allowed = run("info", member);
  EXPECT_EQ(allowed.exit_code, 0) << allowed.output;
  EXPECT_EQ(run("info", stranger).exit_code, 4);
  std::filesystem::remove(file);
  ASSERT_EQ(run_program("udevadm control --reload").exit_code, 0);
}

TEST_P(UsbCommands, TellTwoBoardsApart) {
  const auto second = start_board("SECOND");
  expect_boards(2);
  ASSERT_EQ(run("set-params x.feedback.k1=20 --device usb:SECOND").exit_code, 0);
  EXPECT_EQ(run("diff-params --defaults --device usb:SECOND").exit_code, 1);
  EXPECT_EQ(run("diff-params --defaults --device usb:BENCH").exit_code, 0);
  const ProgramRun unclear = run("info");
  EXPECT_EQ(unclear.exit_code, 3);
  EXPECT_THAT(unclear.output, AllOf(HasSubstr("usb:BENCH"), HasSubstr("usb:SECOND")));
}

/// Long tests that do not depend on the back end.
class UsbBoard : public UsbCommands {};

TEST_P(UsbBoard, IsMeasured) {
  const ProgramRun bench = run("bench --for 20");
  EXPECT_EQ(bench.exit_code, 0) << bench.output;
  for (const char* figure : {"connect and identify", "parameters", "set, read back, verify", "one exchange, median"})
    EXPECT_THAT(bench.output, HasSubstr(figure));
  EXPECT_THAT(bench.output, AllOf(HasSubstr("capture of 20 s"), HasSubstr(" 0 lost")));
  std::cout << bench.output;
}

TEST_P(UsbBoard, OpensAtOnceWhereLinuxPollsItAlways) {
  EXPECT_THAT(run("doctor").output, HasSubstr("udev-rule --poll-always --install"));
  pull_plug();
  const std::string options = run("udev-rule --poll-always").output, name = "options usbhid ";
  ASSERT_THAT(options, StartsWith(name));
  const auto load_usbhid = [](const std::string& with) {
    return run_program("rmmod usbhid && insmod /modules/usbhid.ko " + with).exit_code;
  };
  ASSERT_EQ(load_usbhid(options.substr(name.size())), 0);
  plug_in();
  const ProgramRun bench = run("bench --for 1");
  EXPECT_EQ(bench.exit_code, 0) << bench.output;
  std::cout << "with " << options << bench.output;
  EXPECT_THAT(run("doctor").output, HasSubstr("at once"));
  pull_plug();
  EXPECT_EQ(load_usbhid(""), 0);
}

/// The image is sent block by block; the board disconnects at the restart and returns with the new program.
TEST_P(UsbBoard, IsUpdated) {
  const auto image = [this](const std::string& version) {
    EXPECT_EQ(run("sim --write-image " + folder_.path(version) + " --image-version " + version).exit_code, 0);
    return folder_.path(version);
  };
  const auto told = [this](const std::string& command) {
    const ProgramRun done = run(command + " --json -", "", "2>/dev/null");
    EXPECT_EQ(done.exit_code, 0) << command << "\n" << done.output;
    return nlohmann::json::parse(done.output, nullptr, false);
  };
  ASSERT_EQ(told("info")["version"], "host");
  const nlohmann::json update = told("update " + image("next"));
  EXPECT_EQ(update["written"], true);
  EXPECT_EQ(update["confirmed"], true);
  EXPECT_EQ(told("info")["version"], "next");
  const ProgramRun failed = run("update " + image("hangs"));
  EXPECT_EQ(failed.exit_code, 6) << failed.output;
  EXPECT_THAT(failed.output, HasSubstr("returned to version next"));
  EXPECT_EQ(told("info")["version"], "next");
}

TEST_P(UsbBoard, RunsTheWorkflow) {
  const ProgramRun workflow = run_workflow("usb:BENCH", kCase, folder_.path(""));
  ASSERT_EQ(workflow.exit_code, 0) << workflow.output;
  EXPECT_EQ(host::read_record(folder_.path("jogs.csv")).size(), 2000u);
  const nlohmann::json comparison = nlohmann::json::parse(std::ifstream(folder_.path("comparison.json")));
  EXPECT_LT(comparison["relative_error"].get<double>(), 0.05) << "torque that the identified model leaves unexplained";
}

INSTANTIATE_TEST_SUITE_P(Hidapi, UsbCommands, testing::Values(host::HidBackend::hidraw, host::HidBackend::libusb),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });
INSTANTIATE_TEST_SUITE_P(Hidapi, UsbBoard, testing::Values(host::HidBackend::hidraw),
                         [](const auto& chosen) { return std::string(host::name_of(chosen.param)); });

}  // namespace
