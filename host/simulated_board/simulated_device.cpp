#include "host/simulated_board/simulated_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "firmware/app/protocol/server.hpp"
#include "firmware/app/update/boot_choice.hpp"
#include "hal/pc/simulated_board.hpp"
#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "host/read_file.hpp"
#include "host/simulated_board/simulated_image.hpp"

namespace host {

namespace {

/// Reset causes, as numbered in boards/image/survival_record.hpp.
constexpr std::uint8_t kPowerOn = 1, kSoftwareReset = 3;

void load_flash(hal::pc::SimulatedFlash& flash, const std::string& file) {
  if (file.empty() || !std::filesystem::exists(file)) return;
  const std::string bytes = read_file(file);
  // Files of older versions have smaller sectors and may end after any of them: the first version had no fault log.
  constexpr std::size_t kOldSector = 4096;
  const std::size_t sector_size = bytes.size() <= 4 * kOldSector ? kOldSector : flash.sector_size();
  if (bytes.empty() || bytes.size() % sector_size != 0 || bytes.size() > flash.sector_count() * flash.sector_size())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {} bytes, but a simulated flash has {}: remove the file, or name another", file,
                              bytes.size(), flash.sector_count() * flash.sector_size()));
  auto next = bytes.begin();
  for (auto& sector : flash.contents())
    for (std::size_t i = 0; i < sector_size && next != bytes.end(); ++i) sector[i] = static_cast<std::byte>(*next++);
}

/// The state of a board after `axistool flash`.
hal::pc::SimulatedFlash flashed_images(hal::pc::SimulatedFlash flash) {
  std::ranges::copy(simulated_image("host"), flash.contents()[0].begin());
  return flash;
}

/// Runs the boot code; returns the header of the running image.
firmware::ImageHeader boot(hal::pc::SimulatedFlash& flash, const std::optional<hal::pc::SimulatedFlash>& before) {
  flash = before ? *before : flashed_images(flash);
  firmware::BootChoice(flash).prepare();
  return firmware::ImageSlots(flash).header(0);
}

template <std::size_t axes>
class ProgramOf : public SimulatedProgram {
 public:
  ProgramOf(const SimulatedDeviceOptions& options, const firmware::BootFacts& facts,
            const std::optional<hal::pc::SimulatedFlash>& images)
      : board_(drives_of(options), options.seed, wiring_of(options)),
        image_(boot(board_.image_flash(), images)),
        server_(application_, image_, facts) {
    for (std::size_t i = 0; i < axes; ++i)
      if (options.drives[i].motion) board_.plant(i).hand_over(options.drives[i].motion);
    board_.put_surfaces(options.surfaces);
    load_flash(board_.parameter_flash(), options.flash_file);
    application_.start();
  }

  std::uint32_t run_control_period() override {
    application_.control_period();
    board_.advance();
    if (hangs_) hung_us_ += board_.control_period_us();
    return board_.control_period_us();
  }
  void poll(UsbEnd& usb) override {
    if (!hangs_) server_.poll(usb);
  }
  bool wants_restart() const override { return board_.wants_restart() || hung_us_ >= kWatchdog_us; }
  hal::pc::SimulatedUsb& usb() override { return board_.usb(); }
  const hal::pc::SimulatedFlash& images() override { return board_.image_flash(); }
  hal::pc::SimulatedFlash& flash() override { return board_.parameter_flash(); }

 private:
  using Board = hal::pc::SimulatedBoardOf<axes>;
  using Application = firmware::BoardApplication<float, Board>;

  static typename Board::Drives drives_of(const SimulatedDeviceOptions& options) {
    typename Board::Drives drives;
    std::ranges::transform(options.drives, drives.begin(), &SimulatedDrive::drive);
    return drives;
  }
  static typename Board::Wiring wiring_of(const SimulatedDeviceOptions& options) {
    typename Board::Wiring wiring;
    std::ranges::transform(options.drives, wiring.begin(), &SimulatedDrive::wiring);
    return wiring;
  }

  static constexpr std::uint32_t kWatchdog_us = 50'000;  ///< the same as on the axis board

  Board board_;
  firmware::ImageHeader image_;
  Application application_{board_};
  firmware::ProtocolServer<Application> server_;
  bool hangs_ = std::string_view(image_.version.data()) == kHangingVersion;
  std::uint32_t hung_us_ = 0;
};

std::unique_ptr<SimulatedProgram> start_program(const SimulatedDeviceOptions& options, const firmware::BootFacts& facts,
                                                const std::optional<hal::pc::SimulatedFlash>& images) {
  switch (options.drives.size()) {
    case 1:
      return std::make_unique<ProgramOf<1>>(options, facts, images);
    case 2:
      return std::make_unique<ProgramOf<2>>(options, facts, images);
    case 3:
      return std::make_unique<ProgramOf<3>>(options, facts, images);
    case 4:
      return std::make_unique<ProgramOf<4>>(options, facts, images);
    default:
      throw Failure(ExitCode::usage,
                    fmt::format("a board has 1 to {} axes, not {}", hal::kMostAxes, options.drives.size()));
  }
}

}  // namespace

SimulatedDevice::SimulatedDevice(SimulatedDeviceOptions options) : options_(std::move(options)) {
  for (const SimulatedDrive& drive : options_.drives)
    require_volts(drive.drive.data, drive.drive.name, "a simulated board");
  power_up();
}

void SimulatedDevice::power_up() {
  const bool is_reset = program_ != nullptr;
  std::optional<hal::pc::SimulatedFlash> images;
  if (is_reset) images = program_->images();
  program_.reset();
  if (is_reset) ++resets_;
  try {
    program_ = start_program(options_, {is_reset ? kSoftwareReset : kPowerOn, resets_, true}, images);
  } catch (const std::invalid_argument& error) {
    throw Failure(ExitCode::bad_input, fmt::format("the simulated board cannot run this drive: {}", error.what()));
  }
  flash_operations_ = program_->flash().operations();
}

void SimulatedDevice::keep_flash() {
  flash_operations_ = program_->flash().operations();
  if (options_.flash_file.empty()) return;
  std::string bytes;
  for (const auto& sector : program_->flash().contents())
    bytes.append(reinterpret_cast<const char*>(sector.data()), sector.size());
  write_file_atomically(options_.flash_file, bytes);
}

}  // namespace host
