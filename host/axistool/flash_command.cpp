// axistool flash: writes an image onto a board, over USB or a serial port, with or without GPIO lines, or by a probe.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>
#include <thread>

#include "hal/linux/gpio_line.hpp"
#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/device/flash_sequence.hpp"
#include "host/device/image_file.hpp"
#include "host/read_file.hpp"
#include "host/run_command.hpp"

namespace axistool {

namespace {

struct FlashArguments {
  std::string image = "build/firmware/images/axis-f405.bin";
  std::string board = "axis-f405";
  std::string gpiochip, serial_port, probe;
  unsigned boot0 = 0, reset = 0;
  bool by_probe = false, dry_run = false;
};

/// A temporary folder for the image that is read back.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "axistool-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw host::Failure(host::ExitCode::permission, "no temporary folder: " + pattern);
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

host::FlashRequest request_of(const FlashArguments& arguments, const host::ImageFile& image) {
  host::FlashRequest request;
  request.image = arguments.image;
  request.image_size = image.bytes.size();
  request.serial_port = arguments.serial_port;
  request.probe = arguments.probe;
  if (arguments.by_probe || !arguments.probe.empty()) request.way = host::FlashWay::probe;
  if (!arguments.serial_port.empty()) request.way = host::FlashWay::serial;
  if (!arguments.gpiochip.empty())
    request.gpio = host::GpioWiring{arguments.gpiochip, arguments.boot0, arguments.reset};
  return request;
}

host::Failure gpio_failure(const std::system_error& error) {
  const bool denied = error.code() == std::errc::permission_denied;
  return {denied ? host::ExitCode::permission : host::ExitCode::no_such_device,
          fmt::format(
              "{}{}", error.what(),
              denied ? ": run as root, or join the group that owns the GPIO chip (often gpio)"
                     : ": check --gpiochip (gpiodetect lists the chips), and that no other program holds its lines")};
}

void run_on_hardware(const host::FlashRequest& request, const host::ImageFile& image) {
  using hal::linux_gpio::Drive;
  using hal::linux_gpio::OutputLine;
  std::unique_ptr<OutputLine> boot0, reset;
  if (request.gpio) {
    boot0 = std::make_unique<OutputLine>(request.gpio->chip, request.gpio->boot0, Drive::push_pull, false);
    reset = std::make_unique<OutputLine>(request.gpio->chip, request.gpio->reset, Drive::open_drain, true);
  }
  host::FlashActions actions;
  actions.set_boot0 = [&boot0](bool level) { boot0->set(level); };
  actions.set_reset = [&reset](bool level) { reset->set(level); };
  actions.pause = [](std::chrono::milliseconds time) { std::this_thread::sleep_for(time); };
  actions.run = [](const std::vector<std::string>& command) {
    return host::run_command(command, isatty(STDERR_FILENO) != 0);
  };
  actions.read_back_equals = [&] {
    const std::string back = host::read_file(request.read_back);
    return std::ranges::equal(std::as_bytes(std::span(back)), image.bytes);
  };
  actions.read_options = [&request] {
    const std::string bytes = host::read_file(request.options);
    std::filesystem::remove(request.options);
    return bytes;
  };
  actions.write_options = [](const std::string& file, const std::string& bytes) {
    host::write_file_atomically(file, bytes);
  };
  actions.tell = [](const std::string& text) { fmt::print("{}\n", text); };
  host::run_flash(request, actions);
}

void run(const FlashArguments& arguments) {
  const host::ImageFile image = host::read_image_file(arguments.image);
  host::check_image_for(image, arguments.board);
  if (image.begin == 0)
    throw host::Failure(host::ExitCode::bad_input,
                        fmt::format("{}: an image without the boot code in front of it does not start: give the .bin "
                                    "file that `make firmware` writes",
                                    arguments.image));
  const ScratchFolder scratch;
  host::FlashRequest request = request_of(arguments, image);
  request.read_back = scratch.file("read-back.bin");
  request.options = scratch.file("options.bin");
  fmt::print("{}: {} {} ({}), {} bytes\n", arguments.image, image.header.board.data(), image.header.version.data(),
             image.header.git_hash.data(), image.bytes.size());
  if (arguments.dry_run) {
    for (const host::FlashStep& step : host::flash_steps(request)) fmt::print("would {}\n", describe(step, request));
    return;
  }
  try {
    run_on_hardware(request, image);
  } catch (const std::system_error& error) {
    throw gpio_failure(error);
  }
  fmt::print("done: the board runs the new image\n");
}

}  // namespace

void add_flash(CLI::App& app) {
  auto arguments = std::make_shared<FlashArguments>();
  CLI::App* command = app.add_subcommand("flash", "write an image onto a board and verify it");
  add_input(*command, "IMAGE", arguments->image, "image file (.bin)")->capture_default_str();
  command->add_option("--board", arguments->board, "the board that is connected")->capture_default_str();
  CLI::Option* chip = command->add_option("--gpiochip", arguments->gpiochip, "GPIO chip wired to BOOT0 and NRST");
  CLI::Option* boot0 = command->add_option("--boot0", arguments->boot0, "line of that chip at BOOT0")->needs(chip);
  CLI::Option* reset =
      command->add_option("--reset", arguments->reset, "line of that chip at NRST (driven open-drain)")->needs(chip);
  chip->needs(boot0)->needs(reset);
  CLI::Option* serial = command->add_option("--serial", arguments->serial_port,
                                            "the bootloader's serial port (stm32flash) instead of USB (dfu-util)");
  command->add_flag("--stlink", arguments->by_probe, "by an ST-Link (openocd)")->excludes(chip)->excludes(serial);
  command->add_option("--probe", arguments->probe, "the ST-Link with this serial number")
      ->excludes(chip)
      ->excludes(serial);
  command->add_flag("--dry-run", arguments->dry_run, "print what would be done, and do nothing");
  command->footer(
      "Examples:\n"
      "  axistool flash --gpiochip /dev/gpiochip0 --boot0 17 --reset 27      # from a board computer, no probe\n"
      "  axistool flash --serial /dev/ttyAMA0 --gpiochip /dev/gpiochip0 --boot0 17 --reset 27\n"
      "  axistool flash                                                      # board already in its USB bootloader\n"
      "  axistool flash --stlink --dry-run\n"
      "Also sets the chip's brown-out reset to 2.7 V if needed (not over --serial); without it the board does not "
      "enable\n"
      "any drive. Exit codes: 3 no device or program; 4 permission; 5 verification failed; 8 wrong chip, or its read\n"
      "protection is on; 9 image damaged or for another board.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace axistool
