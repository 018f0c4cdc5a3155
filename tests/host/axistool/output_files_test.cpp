// No command overwrites its inputs, and an output that cannot be written is reported before any computation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "host/read_file.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class OutputFiles : public testing::Test {
 protected:
  OutputFiles() {
    fs::copy_file(kCase + "/model.toml", model);
    fs::copy_file(kCase + "/validate.csv", record);
    fs::copy_file(kCase + "/validate.csv", other_record);
  }

  /// Runs a command that must be refused as wrong usage and must not change its inputs.
  void expect_inputs_kept(const std::string& arguments) {
    const std::string model_before = host::read_file(model), record_before = host::read_file(record);
    const ProgramRun run = run_axistool(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.output;
    EXPECT_THAT(run.output, HasSubstr("input")) << arguments;
    EXPECT_EQ(host::read_file(model), model_before) << arguments;
    EXPECT_EQ(host::read_file(record), record_before) << arguments;
  }

  TemporaryFolder folder;
  const std::string model = folder.path("m.toml"), record = folder.path("r.csv"), other_record = folder.path("o.csv");
};

TEST_F(OutputFiles, NoCommandOverwritesItsInput) {
  const std::string m = " " + model, r = " " + record, o = " -o " + folder.path("new");
  for (const std::string& line : std::vector<std::string>{
           "identify" + r + " --drive" + m + " -o" + r,
           "identify" + r + " --drive" + m + " -o" + m,
           "identify" + r + " --drive" + m + " --json" + r,
           "friction" + r + " --model" + m + " -o" + r,
           "compare" + m + r + " --json" + r,
           "compare" + m + r + " --report" + r,
           "compare" + m + r + " --predictions" + m,
           "diagnose" + m + " --train" + r + " --report" + r,
           "diagnose" + m + " --train" + r + " --json" + m,
           "add" + m + " cogging --train" + r + " -o" + m,
           "adjust" + m + " inertia.J=0.01 --train" + r + " -o" + m,
           "improve" + m + " --train" + r + " -o" + r,
           "improve" + m + " --train" + r + o + " --report" + r,
           "design" + m + " -o" + m,
           "design" + m + " --json" + m,
           "import" + r + " -o" + r,
       })
    expect_inputs_kept(line);
}

/// Input files given by a positional with several meanings, or in the name of a device.
TEST_F(OutputFiles, NoBoardCommandOverwritesItsInput) {
  const std::string m = " " + model, linked = folder.path("linked.toml");
  fs::create_symlink("m.toml", linked);
  const std::string device = " --device model:" + model, by_link = " --device model:" + linked;
  for (const std::string& line :
       std::vector<std::string>{"excite x" + m + " -o" + m, "excite x" + m + " -o " + linked,
                                "excite x" + m + " -o " + folder.path("new") + " --json" + m, "backup" + m + device,
                                "backup" + m + by_link, "backup " + linked + device, "info --json" + m + device,
                                "info --json" + m + " --device plant:" + model + ":cat", "sim --x" + m + " --flash" + m,
                                "sim --x" + m + " --flash " + linked})
    expect_inputs_kept(line);
  const ProgramRun run = run_program("AXIS_DEVICE=model:" + model + " \"" AXISTOOL_PROGRAM "\" backup" + m);
  EXPECT_EQ(run.exit_code, 2) << run.output;
}

TEST_F(OutputFiles, AnInputIsKnownUnderEveryName) {
  const std::string symbolic = folder.path("symbolic.csv"), hard = folder.path("hard.csv");
  fs::create_symlink("r.csv", symbolic);
  fs::create_hard_link(record, hard);
  for (const std::string& name : {symbolic, hard, folder.path("./r.csv")}) {
    expect_inputs_kept("import " + record + " -o " + name);
    expect_inputs_kept("import " + name + " -o " + record);
  }
  EXPECT_TRUE(fs::is_symlink(symbolic));
}

TEST_F(OutputFiles, PredictionsOfSeveralRecordsSpareThemToo) {
  const std::string victim = folder.path("p-1-r.csv");
  fs::rename(other_record, victim);
  const ProgramRun run =
      run_axistool("compare " + model + " " + record + " " + victim + " --predictions " + folder.path("p.csv"));
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_EQ(host::read_file(victim), host::read_file(record));
  EXPECT_FALSE(fs::exists(folder.path("p-2-p-1-r.csv")));
}

TEST_F(OutputFiles, AModelMayBeReadAndWrittenAgainByFriction) {
  const std::string jog = kCase + "/train-jog.csv";
  EXPECT_EQ(run_axistool("friction " + jog + " --model " + model + " -o " + model).exit_code, 0);
  EXPECT_THAT(host::read_file(model), HasSubstr("train-jog.csv"));
}

TEST_F(OutputFiles, ALinkIsFollowedAndRightsAreKept) {
  const std::string target = folder.write("target.toml", "old"), link = folder.path("link.toml");
  ASSERT_EQ(::chmod(target.c_str(), 0640), 0);
  fs::create_symlink("target.toml", link);
  ASSERT_EQ(run_axistool("design " + model + " -o " + link).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_THAT(host::read_file(target), HasSubstr("axis-params/1"));
  EXPECT_EQ(fs::status(target).permissions(), fs::perms(0640));
}

TEST_F(OutputFiles, ALinkToNothingYetIsFollowed) {
  fs::create_symlink("later.toml", folder.path("link.toml"));
  ASSERT_EQ(run_axistool("design " + model + " -o " + folder.path("link.toml")).exit_code, 0);
  EXPECT_TRUE(fs::is_regular_file(folder.path("later.toml")));
  EXPECT_TRUE(fs::is_symlink(folder.path("link.toml")));
}

TEST_F(OutputFiles, WhatIsNoRegularFileIsNoTarget) {
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& target : {pipe, std::string("/dev/null"), folder.path("")}) {
    const ProgramRun run = run_axistool("design " + model + " -o " + target);
    EXPECT_EQ(run.exit_code, 2) << target << run.output;
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(OutputFiles, TwoOutputsInOneFileAreRefused) {
  const ProgramRun run =
      run_axistool("design " + model + " -o " + folder.path("out") + " --json " + folder.path("./out"));
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_FALSE(fs::exists(folder.path("out")));
}

/// The records do not exist: a missing output folder is reported before they are searched.
TEST_F(OutputFiles, FoldersAreCheckedBeforeAnythingIsRead) {
  const std::string missing = folder.path("no/such/x");
  for (const std::string& line : std::vector<std::string>{
           "identify /no/record -o " + missing, "compare /no/model /no/record --report " + missing,
           "compare /no/model /no/record --json " + missing,
           "diagnose /no/model --train /no/record --report " + missing,
           "improve /no/model --train /no/record -o " + missing, "add /no/model cogging --train /no/r -o " + missing,
           "friction /no/record --model /no/model -o " + missing, "design /no/model -o " + missing,
           "import /no/log -o " + missing, "backup " + missing, "capture -o " + missing,
           "faults --record " + missing}) {
    const ProgramRun run = run_axistool(line);
    EXPECT_EQ(run.exit_code, 9) << line;
    EXPECT_THAT(run.output, HasSubstr(missing)) << line;
    EXPECT_THAT(run.output, HasSubstr("folder")) << line;
  }
}

TEST_F(OutputFiles, AFullDiskIsSaid) {
  for (const char* line : {" --json -", ""}) {
    const ProgramRun run = run_axistool("design " + model + line, "2>&1 >/dev/full");
    EXPECT_EQ(run.exit_code, 9) << line;
    EXPECT_THAT(run.output, HasSubstr("standard output")) << line;
  }
  EXPECT_EQ(run_axistool("--help", "2>/dev/null >/dev/full").exit_code, 9);
}

TEST_F(OutputFiles, NothingIsLeftBesideAnOutput) {
  ASSERT_EQ(run_axistool("design " + model + " -o " + folder.path("p.toml")).exit_code, 0);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path(""))) ++files;
  EXPECT_EQ(files, 4u) << "model, two records, parameters";
}

/// A program removes partial files of killed programs, but not those of running programs.
TEST_F(OutputFiles, PartialFilesOfTheDeadGo) {
  const pid_t dead = ::fork();
  if (dead == 0) ::_exit(0);
  ::waitpid(dead, nullptr, 0);
  const std::string left = folder.write(".axistool-" + std::to_string(dead) + "-0.partial", "half"),
                    living = folder.write(".axistool-" + std::to_string(::getpid()) + "-0.partial", "half");
  ASSERT_EQ(run_axistool("design " + model + " -o " + folder.path("p.toml")).exit_code, 0);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(living));
}

TEST_F(OutputFiles, ASimulatedBoardSparesWhatIsNoSocket) {
  const std::string before = host::read_file(record);
  const ProgramRun run = run_axistool("sim --forget --socket " + record);
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_EQ(host::read_file(record), before);
}

TEST_F(OutputFiles, EveryNumberOfEveryCommandIsFinite) {
  const std::string m = " " + model, r = " " + record;
  for (const char* number : {"nan", "inf", "-inf", "1e999", "NaN"}) {
    for (const std::string& line :
         std::vector<std::string>{"compare" + m + r + " --fail-above ",
                                  "compare" + m + r + " --window ",
                                  "import" + r + " -o " + folder.path("n.csv") + " --resample ",
                                  "identify" + r + " --drive" + m + " --deadband ",
                                  "identify" + r + " --drive" + m + " --cutoff ",
                                  "friction" + r + " --model" + m + " --settle ",
                                  "friction" + r + " --model" + m + " --shortest ",
                                  "design" + m + " --rw ",
                                  "design" + m + " --rwd ",
                                  "design" + m + " --ru ",
                                  "design" + m + " --rx ",
                                  "design" + m + " --fc ",
                                  "design" + m + " --zeta ",
                                  "capture -o " + folder.path("n.csv") + " --for ",
                                  "capture -o " + folder.path("n.csv") + " --wait ",
                                  "bench --for ",
                                  "jog x ",
                                  "jog x 1 --for ",
                                  "move x ",
                                  "status --patience "}) {
      const ProgramRun run = run_axistool(line + number);
      EXPECT_EQ(run.exit_code, 2) << line << number << "\n" << run.output;
    }
  }
}

}  // namespace
