// The steps of flashing a board: lines to drive, pauses, and programs to run.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/run_command.hpp"

namespace host {

struct GpioWiring {
  std::string chip;  ///< /dev/gpiochipN
  unsigned boot0 = 0;
  unsigned reset = 0;
};

enum class FlashWay {
  dfu,     ///< ROM bootloader over USB, dfu-util
  serial,  ///< ROM bootloader over a serial port, stm32flash
  probe,   ///< ST-Link, openocd
};

struct FlashRequest {
  FlashWay way = FlashWay::dfu;
  std::string image;               ///< .bin
  std::size_t image_size = 0;      ///< bytes
  std::optional<GpioWiring> gpio;  ///< empty: the board is already in its bootloader
  std::string serial_port;         ///< way serial
  std::string probe;               ///< way probe: serial number; empty if there is only one
  std::string read_back;           ///< file for the image that is read back, for dfu
  std::string options;             ///< likewise for the option bytes
};

struct FlashStep {
  enum class Kind { set_boot0, set_reset, pause, run, brown_out, compare };
  Kind kind = Kind::pause;
  bool level = false;                  ///< set_*: level of the pin; reset is low active
  std::chrono::milliseconds pause{0};  ///< pause
  std::vector<std::string> command;    ///< run
  std::string meaning;
};

/// The whole sequence. Over USB and by a probe it also sets the level of the chip's brown-out reset, unless it is set
/// or read protection is on; over the serial bootloader only the image is written. After a failure between its steps,
/// recovery_steps() lets the board start its present image.
std::vector<FlashStep> flash_steps(const FlashRequest& request);
std::vector<FlashStep> recovery_steps(const FlashRequest& request);

/// One line of text, as a dry run prints it.
std::string describe(const FlashStep& step, const FlashRequest& request);

/// The actions of a sequence; tests replace them.
struct FlashActions {
  std::function<void(bool)> set_boot0, set_reset;
  std::function<void(std::chrono::milliseconds)> pause;
  std::function<CommandResult(const std::vector<std::string>&)> run;
  std::function<bool()> read_back_equals;
  std::function<std::string()> read_options;  ///< first removes the file of the last upload: dfu-util never overwrites
  std::function<void(const std::string& file, const std::string& bytes)> write_options;
  std::function<void(const std::string&)> tell;
};

/// Runs the steps. Throws Failure that names the cause (no device, permission, wrong chip, read protection,
/// verification) and the remedy; by then the board has been reset out of its bootloader.
void run_flash(const FlashRequest& request, const FlashActions& actions);

}  // namespace host
