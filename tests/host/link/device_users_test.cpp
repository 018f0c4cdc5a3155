// The message about a busy board names the program that uses it.
#include "host/link/device_users.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>

#include "host/device/board_client.hpp"
#include "host/exit_codes.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

/// A program that only keeps a file open.
class Holder {
 public:
  explicit Holder(const std::string& file)
      : pipe_(::popen(("exec 3<'" + file + "'; echo $$; exec sleep 60").c_str(), "r")) {
    if (std::fscanf(pipe_, "%d", &process_) != 1) ADD_FAILURE() << "the shell did not start";
  }
  ~Holder() {
    ::kill(process_, SIGKILL);
    ::pclose(pipe_);
  }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;

  int process() const { return process_; }

 private:
  std::FILE* pipe_;
  int process_ = 0;
};

/// A board that does not answer.
class SilentLink : public host::ReportLink {
 public:
  explicit SilentLink(std::string file) : file_(std::move(file)) {}
  void send(const hal::HidReport&) override {}
  std::optional<hal::HidReport> receive(std::chrono::milliseconds) override { return {}; }
  std::string name() const override { return "silent"; }
  std::string file() const override { return file_; }

 private:
  std::string file_;
};

std::string said_by_a_silent_board(const std::string& file) {
  host::BoardClient board(std::make_unique<SilentLink>(file), std::chrono::milliseconds(1));
  try {
    board.identify();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::time_out);
    return failure.what();
  }
  return "";
}

TEST(DeviceUsers, AreTheOtherProcessesThatHaveItOpen) {
  const TemporaryFolder folder;
  const std::string file = folder.write("board", "");
  EXPECT_TRUE(host::users_of(file).empty());
  const Holder holder(file);
  const auto users = host::users_of(file);
  ASSERT_EQ(users.size(), 1u);
  EXPECT_EQ(users[0].process, holder.process());
  EXPECT_TRUE(host::users_of(folder.path("none")).empty());
  EXPECT_TRUE(host::users_of("").empty());
}

TEST(DeviceUsers, ASilentBoardIsNotToBeUnpluggedWhileAnotherProgramUsesIt) {
  const TemporaryFolder folder;
  const std::string file = folder.write("board", "");
  EXPECT_THAT(said_by_a_silent_board(file), HasSubstr("unplug it"));
  const Holder holder(file);
  const std::string said = said_by_a_silent_board(file);
  EXPECT_THAT(said, HasSubstr("process " + std::to_string(holder.process())));
  EXPECT_THAT(said, testing::Not(HasSubstr("unplug")));
}

}  // namespace
