#include "hal/linux/gpio_line.hpp"

#include <gpiod.h>

#include <cerrno>
#include <system_error>

namespace hal::linux_gpio {

namespace {

constexpr const char* kConsumer = "axistool";

[[noreturn]] void fail(const std::string& what) { throw std::system_error(errno, std::generic_category(), what); }

std::string name_of(const std::string& chip, unsigned offset) { return chip + " line " + std::to_string(offset); }

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

Chip open_chip(const std::string& path) {
  Chip chip(gpiod_chip_open(path.c_str()));
  if (!chip) fail("cannot open " + path);
  return chip;
}

}  // namespace

#if AXIS_GPIOD_MAJOR >= 2

namespace {

template <typename T, void (*free_object)(T*)>
struct Free {
  void operator()(T* object) const { free_object(object); }
};
using Settings = std::unique_ptr<gpiod_line_settings, Free<gpiod_line_settings, gpiod_line_settings_free>>;
using Lines = std::unique_ptr<gpiod_line_config, Free<gpiod_line_config, gpiod_line_config_free>>;
using Consumer = std::unique_ptr<gpiod_request_config, Free<gpiod_request_config, gpiod_request_config_free>>;

constexpr gpiod_line_value level(bool value) { return value ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE; }

}  // namespace

struct OutputLine::Request {
  std::string name;
  unsigned offset;
  std::unique_ptr<gpiod_line_request, Free<gpiod_line_request, gpiod_line_request_release>> lines;
};

OutputLine::OutputLine(const std::string& chip_path, unsigned offset, Drive drive, bool value) {
  const std::string name = name_of(chip_path, offset);
  const Chip chip = open_chip(chip_path);
  const Settings settings(gpiod_line_settings_new());
  const Lines lines(gpiod_line_config_new());
  const Consumer consumer(gpiod_request_config_new());
  if (!settings || !lines || !consumer) fail("no memory for " + name);
  gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
  gpiod_line_settings_set_drive(settings.get(),
                                drive == Drive::open_drain ? GPIOD_LINE_DRIVE_OPEN_DRAIN : GPIOD_LINE_DRIVE_PUSH_PULL);
  gpiod_line_settings_set_output_value(settings.get(), level(value));
  gpiod_request_config_set_consumer(consumer.get(), kConsumer);
  if (gpiod_line_config_add_line_settings(lines.get(), &offset, 1, settings.get()) != 0)
    fail("cannot describe " + name);
  gpiod_line_request* request = gpiod_chip_request_lines(chip.get(), consumer.get(), lines.get());
  if (request == nullptr) fail("cannot request " + name);
  request_ = std::make_unique<Request>();
  request_->name = name;
  request_->offset = offset;
  request_->lines.reset(request);
}

void OutputLine::set(bool value) {
  if (gpiod_line_request_set_value(request_->lines.get(), request_->offset, level(value)) != 0)
    fail("cannot set " + request_->name);
}

OutputLine::~OutputLine() = default;

#else

struct OutputLine::Request {
  std::string name;
  Chip chip;
  gpiod_line* line;
};

OutputLine::OutputLine(const std::string& chip_path, unsigned offset, Drive drive, bool value) {
  const std::string name = name_of(chip_path, offset);
  Chip chip = open_chip(chip_path);
  gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
  if (line == nullptr) fail("there is no " + name);
  const int flags = drive == Drive::open_drain ? GPIOD_LINE_REQUEST_FLAG_OPEN_DRAIN : 0;
  if (gpiod_line_request_output_flags(line, kConsumer, flags, value ? 1 : 0) != 0) fail("cannot request " + name);
  request_ = std::make_unique<Request>(Request{name, std::move(chip), line});
}

void OutputLine::set(bool value) {
  if (gpiod_line_set_value(request_->line, value ? 1 : 0) != 0) fail("cannot set " + request_->name);
}

OutputLine::~OutputLine() { gpiod_line_release(request_->line); }

#endif

}  // namespace hal::linux_gpio
