// axistool update, as a user runs it on the simulated board: the new image, the return of the old one, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/host/axistool/simulated_board.hpp"
#include "tests/host/device/sample_image.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

class UpdateCommand : public testing::Test {
 protected:
  std::string file(const char* name) const { return folder_.path(name); }

  /// An image that the simulated board accepts.
  std::string image(const char* version) const {
    const std::string path = file(version);
    EXPECT_EQ(run_axistool("sim --write-image " + path + " --image-version " + version).exit_code, 0);
    return path;
  }
  std::string changed(const char* version, std::size_t offset) const {
    std::ifstream in(image(version), std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(in), {});
    text[offset] ^= 1;
    return folder_.write("changed.bin", text);
  }
  ProgramRun run(const std::string& command) const { return board_.run(command); }
  nlohmann::json json(const std::string& command) const {
    const ProgramRun done = board_.run(command + " --json -", "2>/dev/null");
    EXPECT_EQ(done.exit_code, 0) << command << "\n" << done.output;
    return nlohmann::json::parse(done.output, nullptr, false);
  }
  std::string version() const { return json("info")["version"]; }

  TemporaryFolder folder_;
  SimulatedBoardProcess board_{folder_.path(""), {"--x", kCase + "/model.toml"}};
};

TEST_F(UpdateCommand, ReplacesTheProgramAndKeepsTheOldOne) {
  ASSERT_EQ(run_axistool("design " + kCase + "/model.toml -o " + file("params.toml")).exit_code, 0);
  ASSERT_EQ(run("set-params " + file("params.toml")).exit_code, 0);
  ASSERT_EQ(run("save").exit_code, 0);
  EXPECT_THAT(run("info").output, HasSubstr("runs         what axistool flash wrote"));
  const auto dry = json("update --dry-run " + image("one"));
  EXPECT_EQ(dry["written"], false);
  EXPECT_EQ(version(), "host");

  const auto done = json("update " + file("one"));
  EXPECT_EQ(done["written"], true);
  EXPECT_EQ(done["confirmed"], true);
  EXPECT_EQ(done["from"], "host");
  EXPECT_EQ(done["to"], "one");
  EXPECT_EQ(version(), "one");
  const auto slots = json("info")["slots"];
  EXPECT_EQ(slots[0]["version"], "host");
  EXPECT_EQ(slots[0]["state"], "healthy");
  EXPECT_EQ(slots[0]["runs"], false);
  EXPECT_EQ(slots[1]["version"], "one");
  EXPECT_EQ(slots[1]["runs"], true);
  EXPECT_EQ(run("diff-params " + file("params.toml")).exit_code, 0) << "the saved parameters";

  EXPECT_EQ(json("update " + file("one"))["written"], false) << "it runs already";
  const ProgramRun two = run("update " + image("two"));
  EXPECT_EQ(two.exit_code, 0) << two.output;
  EXPECT_THAT(two.output, AllOf(HasSubstr("version two"), HasSubstr("slot B       healthy, version one")));
  const ProgramRun back = run("update " + file("one"));
  EXPECT_EQ(back.exit_code, 0) << back.output;
  EXPECT_EQ(version(), "one");
  EXPECT_EQ(run("diff-params " + file("params.toml")).exit_code, 0);
}

TEST_F(UpdateCommand, AnImageThatDoesNotStartIsLeftForTheOldOne) {
  const ProgramRun failed = run("update " + image("hangs"));
  EXPECT_EQ(failed.exit_code, 6) << failed.output;
  EXPECT_THAT(failed.output, AllOf(HasSubstr("did not start"), HasSubstr("returned to version host")));
  EXPECT_EQ(version(), "host");
  const auto slots = json("info")["slots"];
  EXPECT_EQ(slots[0]["state"], "healthy");
  EXPECT_EQ(slots[1]["state"], "failed");
  EXPECT_EQ(slots[1]["version"], "hangs");
  EXPECT_EQ(run("update " + image("good")).exit_code, 0);
  EXPECT_EQ(version(), "good");
}

TEST_F(UpdateCommand, RefusesWithTheCauseAndWritesNothing) {
  const auto refused = [&](const std::string& path, const std::string& cause) {
    const ProgramRun done = run("update " + path);
    EXPECT_EQ(done.exit_code, 9) << done.output;
    EXPECT_THAT(done.output, AllOf(HasSubstr(path), HasSubstr(cause)));
  };
  refused(folder_.write("other.bin", image_text("axis-f405")), "the image is for board axis-f405, not simulated");
  refused(changed("one", 3000), "its checksum does not match");
  refused(folder_.write("short.bin", image_text("simulated").substr(0, 650)), "shorter than its header says");
  refused(folder_.write("text.bin", "hello"), "no image header");
  refused(file("absent.bin"), "");
  EXPECT_EQ(json("info")["slots"][1]["state"], "empty");
  EXPECT_EQ(run("update").exit_code, 2);
}

TEST_F(UpdateCommand, FlashTakesNoImageWithoutBootCode) {
  const ProgramRun bare = run_axistool("flash --dry-run " + folder_.write("bare.bin", image_text("axis-f405")));
  EXPECT_EQ(bare.exit_code, 9) << bare.output;
  EXPECT_THAT(bare.output, HasSubstr("without the boot code"));
  const ProgramRun whole = run_axistool("flash --dry-run " + folder_.write("whole.bin", flash_text("axis-f405")));
  EXPECT_EQ(whole.exit_code, 0) << whole.output;
}

TEST_F(UpdateCommand, IsRefusedWhileAnAxisIsEnabled) {
  ASSERT_EQ(run_axistool("design " + kCase + "/model.toml -o " + file("params.toml")).exit_code, 0);
  ASSERT_EQ(run("set-params " + file("params.toml")).exit_code, 0);
  ASSERT_EQ(run("enable x --yes").exit_code, 0);
  const ProgramRun done = run("update " + image("one"));
  EXPECT_EQ(done.exit_code, 8) << done.output;
  EXPECT_THAT(done.output, HasSubstr("axistool disable"));
  EXPECT_EQ(json("info")["slots"][1]["state"], "empty");
}

}  // namespace
