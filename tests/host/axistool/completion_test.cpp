// Completions and manual, which are generated from the commands' own help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string offered(const std::string& words) { return run_axistool("complete -- " + words, "2>/dev/null").output; }

TEST(Completion, KnowsCommandsOptionsEffectsParametersScenariosAndKindsOfFiles) {
  EXPECT_THAT(offered("im"), AllOf(HasSubstr("improve\t"), HasSubstr("import\t"), Not(HasSubstr("identify"))));
  EXPECT_THAT(offered("effects cog"), testing::StartsWith("cogging\t"));
  EXPECT_THAT(offered("add m.toml backl"), testing::StartsWith("backlash\t"));
  EXPECT_EQ(offered("add ''"), ":files toml\n");
  EXPECT_THAT(offered("set-params x.kalman.k1"), AllOf(HasSubstr("x.kalman.k11=\t"), HasSubstr(":files toml")));
  EXPECT_THAT(offered("get-params x.kal"), AllOf(HasSubstr("x.kalman\t"), HasSubstr("x.kalman.k32\t")));
  EXPECT_THAT(offered("hil squ"), testing::StartsWith("square"));
  EXPECT_EQ(offered("identify --method unb"), "unbiased-ls\n");
  EXPECT_EQ(offered("diagnose m.toml --train a.csv ''"), ":files csv\n");
  EXPECT_EQ(offered("compare m.toml ''"), ":files csv toml\n");
  EXPECT_THAT(offered("diagnose m.toml --val"), testing::StartsWith("--validate\t"));
  EXPECT_THAT(offered("help impr"), testing::StartsWith("improve\t"));
  EXPECT_EQ(offered("no-such-command ''"), "");
}

TEST(Completion, BashOffersWordsAndFilesThatFit) {
  const TemporaryFolder folder;
  folder.write("one.toml", "");
  folder.write("two.csv", "");
  const std::string script = folder.path("script");
  ASSERT_EQ(run_axistool("completion bash > " + script).exit_code, 0);
  const auto completed = [&](const std::string& words) {
    return run_program("cd " + folder.path(".") + " && bash -c 'compopt() { :; }; . " + script + "; COMP_WORDS=(" +
                       AXISTOOL_PROGRAM + " " + words +
                       "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _axistool; echo ${COMPREPLY[@]}'")
        .output;
  };
  EXPECT_EQ(completed("effects cog"), "cogging\n");
  EXPECT_EQ(completed("set-params x.feedback.k1"), "x.feedback.k1=\n");
  EXPECT_EQ(completed("identify \"\""), "two.csv\n");
  EXPECT_EQ(completed("identify --drive o"), "one.toml\n");
}

TEST(Completion, ScriptsAreValidWhereTheirShellIsInstalled) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    if (std::system(("command -v " + std::string(shell) + " >/dev/null").c_str()) != 0) continue;
    const ProgramRun run = run_axistool("completion " + std::string(shell) + " | " + shell + " -n");
    EXPECT_EQ(run.exit_code, 0) << shell << ": " << run.output;
  }
  EXPECT_EQ(run_axistool("completion tcsh").exit_code, 2);
}

TEST(Manual, HasAPageForEveryCommandWithEveryOption) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_axistool("man " + folder.path("man1")).exit_code, 0);
  const std::string program = host::read_file(folder.path("man1/axistool.1"));
  std::size_t pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path("man1"))) {
    const std::string name = entry.path().stem().string();
    if (name == "axistool") continue;
    ++pages;
    const std::string page = host::read_file(entry.path().string());
    EXPECT_THAT(page, HasSubstr(".SH NAME\naxistool\\-")) << name;
    const std::string help = run_axistool(name.substr(9) + " --help").output;
    for (std::size_t at = help.find("  --"); at != std::string::npos; at = help.find("  --", at + 1)) {
      std::string option = help.substr(at + 2, help.find_first_of(" \n,", at + 2) - at - 2), troff;
      for (const char letter : option) troff += letter == '-' ? std::string("\\-") : std::string(1, letter);
      EXPECT_THAT(page, HasSubstr(troff)) << name << " " << option;
    }
  }
  EXPECT_GT(pages, 30u);
  EXPECT_THAT(program, HasSubstr("axistool\\-identify"));
}

}  // namespace
