#include "host/device/flash_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/exit_codes.hpp"

namespace host {

namespace {

using Kind = FlashStep::Kind;
using std::chrono::milliseconds;

constexpr const char* kBootloader = "0483:df11";  // STMicroelectronics' DFU bootloader: AN2606, AN3156
constexpr const char* kFlashStart = "0x08000000";
// The STM32F405 bootloader's description of 1 MB of flash (RM0090, table 5).
constexpr const char* kSectors = "04*016Kg,01*064Kg,07*128Kg";
constexpr milliseconds kResetPulse{20};        // the pin needs 20 us (datasheet, table 47); RC on the board: 1 ms
constexpr milliseconds kBootloaderStart{300};  // USB bootloader ready: AN2606, section "STM32F40xxx"; plus enumeration
constexpr milliseconds kSettle{1};
constexpr const char* kNew = ".new";      // suffix of the file with the option bytes to write
constexpr milliseconds kComesBack{1500};  // time until the bootloader has reset itself and USB has enumerated
// 16 bytes: the first contains the brown-out level, the second the read protection (RM0090, 3.6.2 and table 13).
constexpr const char* kOptions = "0x1FFFC000";
constexpr unsigned kBrownOutField = 0x0C, kUnprotected = 0xAA;  // the level of 2.7 V is 0 (RM0090, 3.9.6)

FlashStep set(Kind kind, bool level, const char* meaning) { return {kind, level, {}, {}, meaning}; }
FlashStep wait(milliseconds time, const char* meaning) { return {Kind::pause, false, time, {}, meaning}; }
FlashStep run(std::vector<std::string> command, const char* meaning) {
  return {Kind::run, false, {}, std::move(command), meaning};
}

void append(std::vector<FlashStep>& steps, std::vector<FlashStep> more) {
  for (FlashStep& step : more) steps.push_back(std::move(step));
}

std::vector<FlashStep> enter_bootloader() {
  return {set(Kind::set_boot0, true, "choose the ROM bootloader"),
          wait(kSettle, "let BOOT0 settle"),
          set(Kind::set_reset, false, "reset"),
          wait(kResetPulse, "reset pulse"),
          set(Kind::set_reset, true, "start the bootloader"),
          wait(kBootloaderStart, "bootloader starts, USB enumerates")};
}

std::vector<FlashStep> start_image() {
  return {set(Kind::set_boot0, false, "choose flash"), wait(kSettle, "let BOOT0 settle"),
          set(Kind::set_reset, false, "reset"), wait(kResetPulse, "reset pulse"),
          set(Kind::set_reset, true, "start the image")};
}

std::vector<std::string> read_options(const FlashRequest& request) {
  return {"dfu-util", "-d", kBootloader, "-a", "1", "-s", std::string(kOptions) + ":16", "-U", request.options};
}

/// Commands for openocd. They use the chip's register, which holds the loaded option bytes (RM0090, 3.9.6), and keep
/// all other bits.
std::vector<std::string> brown_out_commands() {
  return {"-c", "init",
          "-c", "reset halt",
          "-c", "set optcr [mrw 0x40023C14]",
          "-c", "if {(($optcr >> 8) & 0xFF) != 0xAA} {echo {axistool: read protection is on}; shutdown error}",
          "-c", "if {($optcr & 0x0C) != 0} {stm32f2x options_write 0 [expr {$optcr & 0xF0}]; reset halt}",
          "-c", "if {([mrw 0x40023C14] & 0x0C) != 0} {echo {axistool: the level was not taken}; shutdown error}"};
}

std::vector<FlashStep> dfu_steps(const FlashRequest& request) {
  const std::string place = fmt::format("{}:{}", kFlashStart, request.image_size);
  std::vector<FlashStep> steps{
      run({"dfu-util", "-l", "-d", kBootloader}, "find the board and identify its chip"),
      run(read_options(request), "read the option bytes"),
      {Kind::brown_out, false, {}, {}, "set the brown-out reset to 2.7 V unless it is, and read protection is off"},
      run({"dfu-util", "-d", kBootloader, "-a", "0", "-s", kFlashStart, "-D", request.image}, "write"),
      run({"dfu-util", "-d", kBootloader, "-a", "0", "-s", place, "-U", request.read_back}, "read back"),
      {Kind::compare, false, {}, {}, "compare what was read back with the image"}};
  if (!request.gpio)
    steps.push_back(
        run({"dfu-util", "-d", kBootloader, "-a", "0", "-s", std::string(kFlashStart) + ":leave", "-D", request.image},
            "write again and leave the bootloader"));
  return steps;
}

constexpr const char* kLevelNotTaken =
    "the chip kept its old brown-out level, so the image was not written: try again, or set the level by ST's "
    "programmer (STM32_Programmer_CLI -ob BOR_LEV=0)";

[[noreturn]] void refuse_protected() {
  throw Failure(
      ExitCode::refused,
      "the chip's read protection is on, and changing its option bytes might erase the chip: nothing was written. "
      "First remove the protection with ST's programmer, which erases the chip with parameters and fault log");
}

[[noreturn]] void explain(const FlashStep& step, const CommandResult& result) {
  const std::string& program = step.command.front();
  const auto says = [&result](const char* text) { return result.output.find(text) != std::string::npos; };
  const auto fail = [](ExitCode code, const std::string& text) { throw Failure(code, text); };
  if (result.status == 127)
    fail(ExitCode::no_such_device, fmt::format("{0} is not installed: apt-get install {0}", program));
  if (says("LIBUSB_ERROR_ACCESS") || says("Permission denied") || says("Cannot open DFU device"))
    fail(ExitCode::permission, fmt::format("{}: no permission for the device: run as root, or give your user access "
                                           "to USB devices of vendor 0483 (udev rule, group plugdev)",
                                           program));
  if (says("No DFU capable USB device") || says("open failed") || says("unable to find"))
    fail(ExitCode::no_such_device,
         program == "openocd" ? "no ST-Link found: is it plugged in, and the board powered? PROBE=serial chooses one"
                              : "no board in its bootloader found: check the USB cable, and BOOT0 high during reset");
  if (says("Failed to init device") || says("Failed to open port") || says("cannot access"))
    fail(ExitCode::no_such_device, program + ": no bootloader answers on the serial port: check port, BOOT0, reset");
  if (says("UNEXPECTED") || says("unexpected idcode") || says("Device ID mismatch"))
    fail(ExitCode::refused, program + ": another chip than an STM32F405 is connected; nothing was written");
  if (says("axistool: read protection is on")) refuse_protected();
  if (says("axistool: the level was not taken")) fail(ExitCode::protocol, kLevelNotTaken);
  if (says("Verify Failed") || says("verify failed") || says("Failed to verify"))
    fail(ExitCode::protocol, program + ": verification failed: flash again; if it fails again, the flash is worn out");
  throw Failure(ExitCode::protocol, fmt::format("{} failed with status {}: {}", program, result.status, result.output));
}

void check_chip(const FlashStep& step, const CommandResult& result) {
  if (step.command.size() < 2 || step.command[0] != "dfu-util" || step.command[1] != "-l") return;
  if (result.output.find("Found DFU") == std::string::npos) explain(step, {1, "No DFU capable USB device"});
  if (result.output.find(kSectors) == std::string::npos)
    throw Failure(
        ExitCode::refused,
        "another chip than an STM32F405 with 1 MB is connected (its flash sectors differ); nothing was written");
}

/// Whether the option bytes that were read have the right level of the brown-out reset.
bool has_brown_out_level(const std::string& options) {
  if (options.size() < 2)
    throw Failure(ExitCode::protocol, "the option bytes cannot be read: try another cable or port, and flash again");
  if (static_cast<unsigned char>(options[1]) != kUnprotected) refuse_protected();
  return (static_cast<unsigned char>(options[0]) & kBrownOutField) == 0;
}

/// The bootloader activates option bytes by a reset, in which dfu-util may lose the connection, so the bytes are read
/// back.
void set_brown_out(const FlashRequest& request, const FlashActions& actions) {
  std::string options = actions.read_options();
  if (has_brown_out_level(options)) return;
  const auto user = static_cast<unsigned char>(static_cast<unsigned char>(options[0]) & ~kBrownOutField);
  options[0] = static_cast<char>(user);
  if (options.size() > 2) options[2] = static_cast<char>(~user);  // the chip requires the complement beside the byte
  actions.write_options(request.options + kNew, options);
  const FlashStep write = run({"dfu-util", "-d", kBootloader, "-a", "1", "-s", kOptions, "-D", request.options + kNew},
                              "set the brown-out reset to 2.7 V");
  actions.tell(describe(write, request));
  const CommandResult written = actions.run(write.command);
  actions.pause(kComesBack);
  const FlashStep again = run(read_options(request), "read the option bytes back");
  actions.tell(describe(again, request));
  const CommandResult result = actions.run(again.command);
  if (result.status != 0) explain(again, result);
  if (!has_brown_out_level(actions.read_options()))
    throw Failure(ExitCode::protocol, written.status == 0 ? std::string(kLevelNotTaken)
                                                          : fmt::format("{} ({})", kLevelNotTaken, written.output));
}

void act(const FlashStep& step, const FlashRequest& request, const FlashActions& actions) {
  actions.tell(describe(step, request));
  switch (step.kind) {
    case Kind::set_boot0:
      actions.set_boot0(step.level);
      break;
    case Kind::set_reset:
      actions.set_reset(step.level);
      break;
    case Kind::pause:
      actions.pause(step.pause);
      break;
    case Kind::run: {
      const CommandResult result = actions.run(step.command);
      if (result.status != 0) explain(step, result);
      check_chip(step, result);
      break;
    }
    case Kind::brown_out:
      set_brown_out(request, actions);
      break;
    case Kind::compare:
      if (!actions.read_back_equals())
        throw Failure(ExitCode::protocol,
                      "verification failed: what was read back differs from the image; flash again");
      break;
  }
}

}  // namespace

std::vector<FlashStep> flash_steps(const FlashRequest& request) {
  std::vector<FlashStep> steps;
  if (request.gpio) append(steps, enter_bootloader());
  switch (request.way) {
    case FlashWay::dfu:
      append(steps, dfu_steps(request));
      break;
    case FlashWay::serial:
      steps.push_back(
          run({"stm32flash", "-w", request.image, "-v", "-S", kFlashStart, request.serial_port}, "write and verify"));
      break;
    case FlashWay::probe: {
      std::vector<std::string> command{"openocd", "-f", "interface/stlink.cfg", "-f", "target/stm32f4x.cfg"};
      if (!request.probe.empty()) command.insert(command.end(), {"-c", "adapter serial " + request.probe});
      for (const std::string& word : brown_out_commands()) command.push_back(word);
      command.insert(command.end(), {"-c", fmt::format("program {} verify reset exit {}", request.image, kFlashStart)});
      steps.push_back(run(command, "set the brown-out reset to 2.7 V unless it is, write, verify and start"));
      break;
    }
  }
  if (request.gpio) append(steps, start_image());
  return steps;
}

std::vector<FlashStep> recovery_steps(const FlashRequest& request) {
  return request.gpio ? start_image() : std::vector<FlashStep>{};
}

std::string describe(const FlashStep& step, const FlashRequest& request) {
  const auto pin = [&](const char* name, unsigned line) {
    return fmt::format("{} (line {}) {}: {}", name, line, step.level ? "high" : "low", step.meaning);
  };
  switch (step.kind) {
    case Kind::set_boot0:
      return pin("BOOT0", request.gpio->boot0);
    case Kind::set_reset:
      return pin("NRST", request.gpio->reset);
    case Kind::pause:
      return fmt::format("wait {} ms: {}", step.pause.count(), step.meaning);
    case Kind::run:
      return fmt::format("run {}: {}", fmt::join(step.command, " "), step.meaning);
    case Kind::brown_out:
    case Kind::compare:
      break;
  }
  return step.meaning;
}

void run_flash(const FlashRequest& request, const FlashActions& actions) {
  try {
    for (const FlashStep& step : flash_steps(request)) act(step, request, actions);
  } catch (const Failure&) {
    for (const FlashStep& step : recovery_steps(request)) act(step, request, actions);
    throw;
  }
}

}  // namespace host
