// Failures during a commissioning: the axis stops, the folder remains usable, and the message gives the remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <random>

#include "tests/host/commission/own_machine.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using host::ExitCode;
using testing::HasSubstr;

/// The folder opens, and the commissioning can continue after the steps that it lists as done.
void expect_usable(const std::string& name) {
  const host::CommissionFolder folder(name);
  EXPECT_EQ(folder.document().at("format"), "axis-commission/1");
}

/// An axis that is held at rest by its controller may stay enabled when the host ends.
void expect_standing(OwnBoard& board) {
  board.link->wait(std::chrono::seconds(2));
  const double there = board.machine->position();
  board.link->wait(std::chrono::seconds(1));
  EXPECT_NEAR(board.machine->position(), there, 0.005);
}

TEST(CommissioningGoesWrong, WhereTheEncoderCountsBackward) {
  const TemporaryFolder folder;
  OwnBoard board;
  board.machine->counts_backward = true;
  const auto [code, words] = commission(board, folder.path("x"), "look", "identify");
  EXPECT_EQ(code, ExitCode::refused);
  EXPECT_THAT(words, HasSubstr("swap the encoder's two channels"));
  EXPECT_THAT(words, HasSubstr("--from look"));
  expect_standing(board);
  expect_usable(folder.path("x"));
}

TEST(CommissioningGoesWrong, WhereALimitSwitchIsHit) {
  const TemporaryFolder folder;
  hal::pc::AxisWiring wiring;
  wiring.positive_end = 3.0;
  OwnBoard board(wiring);
  const auto [code, words] = commission(board, folder.path("x"), "look", "identify");
  EXPECT_EQ(code, ExitCode::device_fault);
  EXPECT_THAT(words, HasSubstr("limit_switch_positive"));
  expect_standing(board);
  expect_usable(folder.path("x"));
}

TEST(CommissioningGoesWrong, WhereTheUserSaysNo) {
  const TemporaryFolder folder;
  OwnBoard board;
  host::CommissionTalk talk;
  int asked = 0;
  talk.consents = [&](const std::string&) { return ++asked < 2; };
  const auto [code, words] = commission(board, folder.path("x"), "look", "ladder", talk);
  EXPECT_EQ(code, ExitCode::refused);
  EXPECT_THAT(words, HasSubstr("identify: not done, as you wished"));
  EXPECT_EQ(commission(board, folder.path("x"), "identify", "control").first, ExitCode::done);
}

TEST(CommissioningGoesWrong, WhereTheUserInterruptsAndCanGoOn) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 10; ++trial) {
    const TemporaryFolder folder;
    OwnBoard board;
    host::CommissionTalk talk;
    long asked = std::uniform_int_distribution<long>(1, 3000)(random);
    talk.stop = [&] { return --asked <= 0; };
    const auto [code, words] = commission(board, folder.path("x"), "look", "ladder", talk);
    expect_standing(board);
    if (code == ExitCode::done) continue;
    EXPECT_EQ(code, ExitCode::refused) << words;
    EXPECT_THAT(words, HasSubstr("interrupted"));
    const auto next = host::CommissionFolder(folder.path("x")).first_undone();
    ASSERT_TRUE(next.has_value());
    EXPECT_EQ(commission(board, folder.path("x"), host::kCommissionSteps[*next].name.data(), "ladder").first,
              ExitCode::done);
  }
}

/// Number of failure times: `usual`, or AXIS_COMMISSION_TRIALS.
int trials(int usual) {
  const char* wanted = std::getenv("AXIS_COMMISSION_TRIALS");
  return wanted != nullptr ? std::atoi(wanted) : usual;
}

/// The program ends or its cable is unplugged: the board must stop without a request.
TEST(CommissioningGoesWrong, WhereTheHostGoesAtAnyMoment) {
  std::mt19937 random(11);
  for (int trial = 0; trial < trials(kInstrumented ? 2 : 20); ++trial) {
    const TemporaryFolder folder;
    OwnBoard board;
    board.reports_left = std::uniform_int_distribution<long>(1, 14000)(random);
    const auto [code, words] = commission(board, folder.path("x"), "look", "response");
    expect_standing(board);
    expect_usable(folder.path("x"));
    if (code == ExitCode::done) continue;
    EXPECT_EQ(code, ExitCode::no_such_device) << words;
    if (trial % 10 != 0) continue;
    board.reports_left = -1;
    {
      host::BoardClient client = board.client();
      client.clear_faults();
      client.wait(std::chrono::milliseconds(500));
    }
    const auto next = host::CommissionFolder(folder.path("x")).first_undone();
    const auto again = commission(board, folder.path("x"), host::kCommissionSteps[*next].name.data(), "response");
    EXPECT_EQ(again.first, ExitCode::done) << again.second;
  }
}

/// After a kill no handler runs: unfinished files are missing, existing ones are complete, and the commissioning can
/// continue on a restarted board.
TEST(CommissioningGoesWrong, WhereTheProgramIsKilledAtAnyMoment) {
  std::mt19937 random(17);
  for (int trial = 0; trial < trials(kInstrumented ? 2 : 10); ++trial) {
    const TemporaryFolder folder;
    const long reports = std::uniform_int_distribution<long>(1, 14000)(random);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      OwnBoard board;
      board.reports_left = reports;
      board.dies_then = true;
      ::_exit(commission(board, folder.path("x"), "look", "response").first == ExitCode::done ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << trial;
    expect_usable(folder.path("x"));
    if (!WIFSIGNALED(status) || trial % 5 != 0) continue;
    OwnBoard board;
    const auto next = host::CommissionFolder(folder.path("x")).first_undone();
    ASSERT_TRUE(next.has_value());
    const auto again = commission(board, folder.path("x"), host::kCommissionSteps[*next].name.data(), "response");
    EXPECT_EQ(again.first, ExitCode::done) << trial << ": " << again.second;
  }
}

TEST(CommissioningGoesWrong, WhereTheAxisSeizes) {
  const TemporaryFolder folder;
  OwnBoard board;
  ASSERT_EQ(commission(board, folder.path("x"), "look", "home").first, ExitCode::done);
  board.machine->seizes_at_s = 0.0;
  const auto [code, words] = commission(board, folder.path("x"), "ladder", "ladder");
  EXPECT_EQ(code, ExitCode::device_fault);
  EXPECT_THAT(words, HasSubstr("command_without_motion"));
  EXPECT_THAT(words, HasSubstr("--from ladder"));
  expect_standing(board);
  expect_usable(folder.path("x"));
  board.machine->seizes_at_s = HUGE_VAL;
  {
    host::BoardClient client = board.client();
    client.clear_faults();
    client.wait(std::chrono::milliseconds(500));
  }
  EXPECT_EQ(commission(board, folder.path("x"), "ladder", "friction").first, ExitCode::done);
}

TEST(CommissioningGoesWrong, WhereTheDiskIsFull) {
  const TemporaryFolder folder;
  OwnBoard board;
  ASSERT_EQ(commission(board, folder.path("x"), "look", "look").first, ExitCode::done);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};  // a record does not fit
  ::setrlimit(RLIMIT_FSIZE, &small);
  const auto [code, words] = commission(board, folder.path("x"), "identify", "ladder");
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(code, ExitCode::done);
  EXPECT_THAT(words, HasSubstr("steps.csv"));
  expect_standing(board);
  expect_usable(folder.path("x"));
  EXPECT_EQ(commission(board, folder.path("x"), "identify", "ladder").first, ExitCode::done);
}

TEST(CommissioningGoesWrong, WhereAFileOfAnEarlierStepIsMissing) {
  const TemporaryFolder folder;
  OwnBoard board;
  const auto [code, words] = commission(board, folder.path("x"), "friction", "friction");
  EXPECT_EQ(code, ExitCode::usage);
  EXPECT_THAT(words, HasSubstr("--from identify"));
}

}  // namespace
