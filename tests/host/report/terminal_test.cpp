#include "host/report/terminal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <thread>

#include "host/report/progress.hpp"
#include "tests/host/report/sample_report.hpp"

namespace host {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A terminal of 80 columns that records its output.
class PseudoTerminal {
 public:
  PseudoTerminal() {
    const winsize size{24, 80, 0, 0};
    int user_side = -1;
    if (::openpty(&reader_, &user_side, nullptr, nullptr, &size) == 0) stream_ = ::fdopen(user_side, "w");
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() {
    if (stream_ != nullptr) std::fclose(stream_);
    ::close(reader_);
  }
  std::FILE* stream() { return stream_; }
  std::string written() {
    std::fputs("END", stream_);
    std::fflush(stream_);
    std::string text;
    char letter = 0;
    while (!text.ends_with("END") && ::read(reader_, &letter, 1) == 1) text += letter;
    return text.substr(0, text.size() - 3);
  }

 private:
  int reader_ = -1;
  std::FILE* stream_ = nullptr;
};

TEST(Terminal, ColourOnlyOnATerminalThatWantsIt) {
  ::setenv("TERM", "xterm", 1);
  ::unsetenv("NO_COLOR");
  PseudoTerminal pseudo;
  ASSERT_NE(pseudo.stream(), nullptr);
  EXPECT_TRUE(terminal_of(pseudo.stream()).colour);
  EXPECT_EQ(terminal_of(pseudo.stream()).columns, 80);
  ::setenv("NO_COLOR", "1", 1);
  EXPECT_FALSE(terminal_of(pseudo.stream()).colour);
  ::unsetenv("NO_COLOR");
  ::setenv("TERM", "dumb", 1);
  EXPECT_FALSE(terminal_of(pseudo.stream()).colour);
  ::setenv("TERM", "xterm", 1);
  std::FILE* file = std::tmpfile();
  EXPECT_FALSE(terminal_of(file).colour);
  EXPECT_FALSE(terminal_of(file).is_terminal);
  std::fclose(file);
  EXPECT_EQ(coloured("fine", Tone::good, {true, true, 80}), "\x1b[1;32mfine\x1b[0m");
  EXPECT_EQ(coloured("fine", Tone::good, {true, false, 80}), "fine");
}

TEST(Terminal, BarsAreScaledAndCarryTheReference) {
  const std::string text = terminal_bars(sample::ladder(), {false, false, 60});
  // Of 60 columns, labels (9), names (12), values (17) and blanks (2) leave 20 cells; the noise floor of 1 is a tenth
  // of 10.
  EXPECT_EQ(text,
            "Ladder of errors\n"
            "as given   training    ██|█████████████     8.00 × floor\n"
            "           validation  ██|█████████████████ 10.0 × floor\n"
            "+ cogging  training    ██|                  1.00 × floor\n"
            "           validation    |                  –\n"
            "           | floor\n");
}

TEST(Terminal, ColourOfBarsIsEndedOnEveryLine) {
  const std::string text = terminal_bars(sample::ladder(), {true, true, 60});
  EXPECT_THAT(text, HasSubstr("\x1b[34m"));
  EXPECT_THAT(text, HasSubstr("\x1b[0m 10.0 × floor\n"));
}

TEST(Terminal, TablesAlignByWhatTheReaderSees) {
  const Table table{"", "", {"effect", "after"}, {{"Reibung µ", "1.10"}, {"cogging", "12.3"}}};
  EXPECT_EQ(terminal_table(table, {}),
            "effect     after\n"
            "─────────  ─────\n"
            "Reibung µ   1.10\n"
            "cogging     12.3\n");
}

TEST(Terminal, SentencesAreBrokenAtBlanks) {
  EXPECT_EQ(wrapped("one two three", 9, "  "), "  one two\n  three\n");
  EXPECT_EQ(wrapped("unbreakablyLong word", 5), "unbreakablyLong\nword\n");
  EXPECT_EQ(wrapped("", 20), "");
  EXPECT_EQ(terminal_verdict({Tone::bad, "wrong", "It is off.", {"By 3 %."}, "axistool x"}, {}),
            "wrong\nIt is off.\n  By 3 %.\n  axistool x\n");
}

TEST(Progress, ShowsOneLineOnATerminalAndWipesIt) {
  PseudoTerminal pseudo;
  ASSERT_NE(pseudo.stream(), nullptr);
  {
    Progress progress("fitting", 4, pseudo.stream(), std::chrono::milliseconds(0));
    progress.advance(1, "cogging");
  }
  const std::string text = pseudo.written();
  EXPECT_THAT(text, HasSubstr("fitting: 25 %"));
  EXPECT_THAT(text, HasSubstr("(cogging)"));
  EXPECT_THAT(text, Not(HasSubstr("\n")));
  EXPECT_TRUE(text.ends_with("\r\x1b[K"));
}

TEST(Progress, IsSilentWhileTheWorkIsShort) {
  PseudoTerminal pseudo;
  ASSERT_NE(pseudo.stream(), nullptr);
  {
    Progress progress("fitting", 4, pseudo.stream(), std::chrono::hours(1));
    progress.advance(3);
  }
  EXPECT_EQ(pseudo.written(), "");
}

TEST(Progress, LeavesFilesAlone) {
  std::FILE* file = std::tmpfile();
  {
    Progress progress("fitting", 4, file, std::chrono::milliseconds(0));
    progress.advance(3);
  }
  EXPECT_EQ(std::ftell(file), 0);
  std::fclose(file);
}

TEST(Progress, CountsFromSeveralThreads) {
  PseudoTerminal pseudo;
  ASSERT_NE(pseudo.stream(), nullptr);
  {
    Progress progress("fitting", 4001, pseudo.stream(), std::chrono::milliseconds(0));
    std::vector<std::thread> workers;
    for (int worker = 0; worker < 4; ++worker) {
      workers.emplace_back([&] {
        for (int step = 0; step < 1000; ++step) progress.advance();
      });
    }
    for (std::thread& worker : workers) worker.join();
    progress.add_steps(3999);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    progress.advance(0);
  }
  EXPECT_THAT(pseudo.written(), HasSubstr("fitting: 50 %"));
}

}  // namespace
}  // namespace host
