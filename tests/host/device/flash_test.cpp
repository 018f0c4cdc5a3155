// Flashing: the edges and pauses of the sequence, and the result of each failure.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/device/flash_sequence.hpp"
#include "host/device/image_file.hpp"
#include "host/exit_codes.hpp"
#include "host/run_command.hpp"
#include "tests/host/device/sample_image.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using namespace std::chrono_literals;

constexpr const char* kListing =
    "Found DFU: [0483:df11] ver=2200, alt=0, name=\"@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg\"";

/// A board computer that records all actions and the time of the pauses.
struct Bench {
  struct Event {
    std::string what;
    std::chrono::milliseconds at;
  };
  std::vector<Event> events;
  std::chrono::milliseconds now{0};
  host::CommandResult list{0, kListing}, write{0, ""};
  bool equal = true;
  /// Option bytes of the chip at 0x1FFFC000: user byte, read protection, their complements.
  std::string options{"\xE3\xAA\x1C\x55\0\0\0\0\xFF\x0F\0\xF0\0\0\0\0", 16};
  std::string sent;        ///< option bytes that the host wrote
  bool takes_them = true;  ///< whether the chip accepts them at its reset
  int status_of_options = 0;

  host::FlashActions actions() {
    host::FlashActions all;
    all.set_boot0 = [this](bool level) { events.push_back({level ? "boot0 high" : "boot0 low", now}); };
    all.set_reset = [this](bool level) { events.push_back({level ? "reset high" : "reset low", now}); };
    all.pause = [this](std::chrono::milliseconds time) { now += time; };
    all.run = [this](const std::vector<std::string>& command) {
      const bool lists = command[1] == "-l";
      if (command[0] == "dfu-util" && command.size() > 4 && command[4] == "1") {
        const bool writes = std::find(command.begin(), command.end(), "-D") != command.end();
        events.push_back({writes ? "write options" : "read options", now});
        if (writes && takes_them) options = sent;
        return host::CommandResult{writes ? status_of_options : 0, "LIBUSB_ERROR_NO_DEVICE"};
      }
      events.push_back({lists ? "list" : command[0], now});
      return lists ? list : write;
    };
    all.read_back_equals = [this] { return equal; };
    all.read_options = [this] { return options; };
    all.write_options = [this](const std::string& file, const std::string& bytes) {
      EXPECT_EQ(file, "options.bin.new");
      sent = bytes;
    };
    all.tell = [](const std::string&) {};
    return all;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Event& event : events) result.push_back(event.what);
    return result;
  }
};

host::FlashRequest with_gpio() {
  host::FlashRequest request;
  request.image = "image.bin";
  request.image_size = 1234;
  request.options = "options.bin";
  request.gpio = host::GpioWiring{"/dev/gpiochip0", 17, 27};
  return request;
}

TEST(Flash, EdgesComeInOrderWithTheirPauses) {
  Bench bench;
  host::run_flash(with_gpio(), bench.actions());
  const std::vector<std::string> expected{"boot0 high", "reset low", "reset high", "list",      "read options",
                                          "dfu-util",   "dfu-util",  "boot0 low",  "reset low", "reset high"};
  ASSERT_EQ(bench.names(), expected);
  EXPECT_GE(bench.events[1].at - bench.events[0].at, 1ms) << "BOOT0 is stable before reset";
  EXPECT_GE(bench.events[2].at - bench.events[1].at, 10ms) << "reset pulse";
  EXPECT_GE(bench.events[3].at - bench.events[2].at, 100ms) << "the bootloader needs time";
  EXPECT_GE(bench.events[9].at - bench.events[8].at, 10ms) << "reset pulse";
}

/// Catches a level in the wrong bits, repeated writing, and changes of other bits.
TEST(Flash, SetsTheBrownOutLevelOnceBeforeTheImage) {
  for (const int status : {0, 74}) {  // dfu-util may lose the bootloader, which resets
    Bench bench;
    bench.status_of_options = status;
    bench.options[0] = '\xEF';
    bench.options[2] = '\x10';
    const std::string before = bench.options;
    host::run_flash(with_gpio(), bench.actions());
    const std::vector<std::string> expected{"boot0 high",   "reset low",     "reset high",   "list",
                                            "read options", "write options", "read options", "dfu-util",
                                            "dfu-util",     "boot0 low",     "reset low",    "reset high"};
    ASSERT_EQ(bench.names(), expected);
    EXPECT_GE(bench.events[6].at - bench.events[5].at, 1000ms) << "the bootloader starts again";
    ASSERT_EQ(bench.sent.size(), 16u);
    EXPECT_EQ(bench.sent[0], '\xE3');
    EXPECT_EQ(bench.sent[2], '\x1C') << "the complement";
    for (const std::size_t i : {1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15})
      EXPECT_EQ(bench.sent[i], before[i]) << i;
    bench.events.clear();
    host::run_flash(with_gpio(), bench.actions());
    EXPECT_EQ(bench.names().size(), 10u) << "it is set: nothing to write";
  }
}

TEST(Flash, WritesNothingWhereReadProtectionIsOn) {
  for (const char level : {'\x55', '\xCC', '\xAB', '\0'}) {
    Bench bench;
    bench.options[1] = level;
    bench.options[0] = '\xEF';
    try {
      host::run_flash(with_gpio(), bench.actions());
      FAIL() << "no failure";
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::refused);
      EXPECT_NE(std::string(failure.what()).find("nothing was written"), std::string::npos);
    }
    EXPECT_TRUE(bench.sent.empty());
    const auto names = bench.names();
    EXPECT_EQ(std::count(names.begin(), names.end(), "dfu-util"), 0);
    EXPECT_EQ(names.back(), "reset high") << "the board leaves its bootloader";
  }
}

TEST(Flash, SaysSoWhereTheChipDoesNotTakeTheLevel) {
  Bench bench;
  bench.options[0] = '\xEF';
  bench.takes_them = false;
  EXPECT_THROW(host::run_flash(with_gpio(), bench.actions()), host::Failure);
  const auto names = bench.names();
  EXPECT_EQ(std::count(names.begin(), names.end(), "dfu-util"), 0) << "no image";
  bench.options.clear();
  EXPECT_THROW(host::run_flash(with_gpio(), bench.actions()), host::Failure) << "an empty upload";
}

/// openocd's script checks the protection first and writes the image last.
TEST(Flash, GivesTheProbeTheSameRule) {
  host::FlashRequest request;
  request.way = host::FlashWay::probe;
  request.image = "image.bin";
  const auto steps = host::flash_steps(request);
  ASSERT_EQ(steps.size(), 1u);
  const auto& command = steps[0].command;
  const auto place = [&](const std::string& text) {
    return std::find_if(command.begin(), command.end(),
                        [&](const std::string& word) { return word.find(text) != std::string::npos; }) -
           command.begin();
  };
  const auto size = static_cast<std::ptrdiff_t>(command.size());
  EXPECT_LT(place("!= 0xAA"), place("options_write"));
  EXPECT_LT(place("options_write"), place("program image.bin"));
  EXPECT_LT(place("program image.bin"), size);
  Bench bench;
  for (const auto& [output, code] : {std::pair{"axistool: read protection is on", host::ExitCode::refused},
                                     std::pair{"axistool: the level was not taken", host::ExitCode::protocol}}) {
    bench.write = {1, output};
    try {
      host::run_flash(request, bench.actions());
      FAIL() << "no failure";
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, code) << output;
    }
  }
}

struct Trouble {
  const char* name;
  int list_status;
  const char* list_output;
  int write_status;
  const char* write_output;
  bool equal;
  host::ExitCode code;
  const char* says;
};

class FlashTrouble : public testing::TestWithParam<Trouble> {};

TEST_P(FlashTrouble, IsNamedAndTheBoardIsLetGo) {
  Bench bench;
  bench.list = {GetParam().list_status, GetParam().list_output};
  bench.write = {GetParam().write_status, GetParam().write_output};
  bench.equal = GetParam().equal;
  try {
    host::run_flash(with_gpio(), bench.actions());
    FAIL() << "no failure";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, GetParam().code);
    EXPECT_NE(std::string(failure.what()).find(GetParam().says), std::string::npos) << failure.what();
  }
  const auto names = bench.names();
  ASSERT_GE(names.size(), 3u);
  EXPECT_EQ(names[names.size() - 3], "boot0 low");
  EXPECT_EQ(names.back(), "reset high");
}

INSTANTIATE_TEST_SUITE_P(
    Flash, FlashTrouble,
    testing::Values(
        Trouble{"not_installed", 127, "", 0, "", true, host::ExitCode::no_such_device, "apt-get install"},
        Trouble{"no_board", 0, "dfu-util 0.11", 0, "", true, host::ExitCode::no_such_device, "no board"},
        Trouble{"no_permission", 74, "Cannot open DFU device 0483:df11 (LIBUSB_ERROR_ACCESS)", 0, "", true,
                host::ExitCode::permission, "udev"},
        Trouble{"wrong_chip", 0, "Found DFU: name=\"@Internal Flash /0x08000000/064*0002Kg\"", 0, "", true,
                host::ExitCode::refused, "nothing was written"},
        Trouble{"write_fails", 0, kListing, 74, "error during download", true, host::ExitCode::protocol, "download"},
        Trouble{"read_back_differs", 0, kListing, 0, "", false, host::ExitCode::protocol, "verification failed"}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

host::ExitCode code_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const host::Failure& failure) {
    return failure.code;
  }
  return host::ExitCode::done;
}

TEST(ImageFile, OnlyAWholeImageForThisBoardPasses) {
  const TemporaryFolder folder;
  const auto good = host::read_image_file(folder.write("good.bin", image_text("axis-f405")));
  EXPECT_EQ(good.state, firmware::ImageState::whole);
  EXPECT_EQ(code_of([&] { host::check_image_for(good, "axis-f405"); }), host::ExitCode::done);
  EXPECT_EQ(code_of([&] { host::check_image_for(good, "other"); }), host::ExitCode::bad_input);

  std::string damaged = image_text("axis-f405");
  damaged.back() ^= 1;
  EXPECT_EQ(host::read_image_file(folder.write("damaged.bin", damaged)).state, firmware::ImageState::wrong_crc);
  EXPECT_EQ(host::read_image_file(folder.write("short.bin", image_text("axis-f405").substr(0, 620))).state,
            firmware::ImageState::wrong_size);
  EXPECT_EQ(code_of([&] { host::read_image_file(folder.write("text.bin", "hello")); }), host::ExitCode::bad_input);
}

TEST(ImageFile, MayLieBehindBootCode) {
  const TemporaryFolder folder;
  const auto whole = host::read_image_file(folder.write("whole.bin", flash_text("axis-f405") + "behind it"));
  EXPECT_EQ(whole.state, firmware::ImageState::whole);
  EXPECT_EQ(whole.begin, firmware::kBootCodeSize);
  const std::string image = image_text("axis-f405");
  EXPECT_TRUE(std::ranges::equal(whole.image(), std::as_bytes(std::span(image))));
  const auto bare = host::read_image_file(folder.write("bare.bin", image));
  EXPECT_EQ(bare.begin, 0u);
  EXPECT_TRUE(std::ranges::equal(bare.image(), std::as_bytes(std::span(image))));
  const auto cut = host::read_image_file(folder.write("cut.bin", flash_text("axis-f405").substr(0, 16384 + 620)));
  EXPECT_EQ(cut.state, firmware::ImageState::wrong_size);
  EXPECT_EQ(cut.image().size(), 620u) << "no more than there is";
}

TEST(Crc32, IsTheWorldsCrc32) {
  const std::string check = "123456789";  // the check value that every catalogue of CRCs gives
  EXPECT_EQ(firmware::crc32(std::as_bytes(std::span(check))), 0xCBF43926u);
}

TEST(RunCommand, KeepsOutputAndStatus) {
  const host::CommandResult result = host::run_command({"sh", "-c", "echo out; echo err >&2; exit 3"}, false);
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.output.find("out"), std::string::npos);
  EXPECT_NE(result.output.find("err"), std::string::npos);
  EXPECT_EQ(host::run_command({"no-such-program-here"}, false).status, 127);
}

}  // namespace
