#include "host/device/simulated_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/read_file.hpp"

namespace host {

namespace {

/// As boards/image/survival_record.hpp numbers them.
constexpr std::uint8_t kPowerOn = 1, kSoftwareReset = 3;

void load_flash(hal::pc::SimulatedFlash& flash, const std::string& file) {
  if (file.empty() || !std::filesystem::exists(file)) return;
  const std::string bytes = read_file(file);
  if (bytes.size() != flash.sector_count() * flash.sector_size())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {} bytes are no simulated flash (it has {}): remove the file, or name another", file,
                              bytes.size(), flash.sector_count() * flash.sector_size()));
  auto next = bytes.begin();
  for (auto& sector : flash.contents())
    for (std::byte& cell : sector) cell = static_cast<std::byte>(*next++);
}

}  // namespace

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options) : options_(options) {
  constexpr std::string_view kBoard = "simulated";
  std::ranges::copy(kBoard, image_.board.begin());
  std::ranges::copy(std::string_view("host"), image_.version.begin());
  power_up();
}

void SimulatedDevice::power_up() {
  const bool is_reset = board_ != nullptr;
  server_.reset();
  application_.reset();
  try {
    board_ = std::make_unique<hal::pc::SimulatedBoard>(options_.x, options_.y, options_.seed);
  } catch (const std::invalid_argument& error) {
    throw Failure(ExitCode::bad_input, fmt::format("the simulated board cannot run this drive: {}", error.what()));
  }
  load_flash(board_->parameter_flash(), options_.flash_file);
  application_ = std::make_unique<Application>(*board_);
  if (is_reset) ++resets_;
  const firmware::BootFacts boot{is_reset ? kSoftwareReset : kPowerOn, resets_, true};
  server_ = std::make_unique<firmware::ProtocolServer<Application>>(*application_, image_, boot);
  application_->start();
  flash_operations_ = board_->parameter_flash().operations();
}

std::uint32_t SimulatedDevice::run_control_period() {
  application_->control_period();
  board_->advance();
  return board_->control_period_us();
}

void SimulatedDevice::keep_flash() {
  flash_operations_ = board_->parameter_flash().operations();
  if (options_.flash_file.empty()) return;
  std::string bytes;
  for (const auto& sector : board_->parameter_flash().contents())
    bytes.append(reinterpret_cast<const char*>(sector.data()), sector.size());
  write_file_atomically(options_.flash_file, bytes);
}

}  // namespace host
