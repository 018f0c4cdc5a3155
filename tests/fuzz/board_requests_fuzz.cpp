// Any bytes as what a host sends: the board answers every report, keeps its parameters admissible, never enables an
// axis that has none, and has a program at every reset.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "firmware/app/protocol/server.hpp"
#include "firmware/app/update/boot_choice.hpp"
#include "hal/pc/simulated_board.hpp"
#include "host/simulated_board/simulated_image.hpp"

namespace {

using Application = firmware::BoardApplication<float, hal::pc::SimulatedBoard>;

sim::DriveDescription small_drive() {
  sim::DriveDescription drive;
  drive.data.amplifier_gain_A_per_V = drive.data.torque_constant_Nm_per_A = drive.data.lead = 1.0;
  drive.data.dac_resolution_V = 20.0 / 65536;
  drive.data.encoder_resolution = 0.001;
  drive.effects = {{"inertia", {{"J", 0.01}}, {}, {}}};
  return drive;
}

void seal(hal::HidReport& report) {
  report[0] = std::byte{firmware::kProtocolVersion};
  const std::uint32_t crc = firmware::crc32(std::span(report).first(firmware::kCrcOffset));
  std::memcpy(report.data() + firmware::kCrcOffset, &crc, sizeof crc);
}

}  // namespace

/// Each piece is a byte, whose lowest bit requests a correct checksum, and a report. A control period follows.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostReports = 64;
  hal::pc::SimulatedBoard board({small_drive(), small_drive()}, 1);
  Application application(board);
  const auto program = host::simulated_image("fuzz");
  std::ranges::copy(program, board.image_flash().contents()[0].begin());
  const firmware::ImageHeader image = firmware::ImageSlots(board.image_flash()).header(0);
  firmware::ProtocolServer<Application> server(application, image, {});
  application.start();
  board.usb().plug_in();
  for (std::size_t n = 0; n < kMostReports && size > hal::kHidReportSize; ++n) {
    hal::HidReport report;
    std::memcpy(report.data(), data + 1, report.size());
    if ((data[0] & 1) != 0) seal(report);
    data += 1 + report.size();
    size -= 1 + report.size();
    if (!board.usb().host_send(report)) std::abort();
    server.poll(board.usb());
    hal::HidReport reply;
    firmware::Message message;
    if (!board.usb().host_receive(reply) || firmware::decode(reply, message) != firmware::Status::ok) std::abort();
    application.control_period();
    server.poll(board.usb());
    while (board.usb().host_receive(reply)) continue;
    if (firmware::check<float>(application.active()).kind != firmware::ValueRefusal::none) std::abort();
    for (std::size_t axis = 0; axis < hal::kAxisCount; ++axis)
      if (board.axis(axis).drive_enable().is_on() && !application.is_fitted(axis)) std::abort();
  }
  // At the next reset, and at the one after the trial of an unconfirmed image.
  firmware::BootChoice boot(board.image_flash());
  if (boot.prepare() == firmware::BootResult::nothing || boot.prepare() != firmware::BootResult::program) std::abort();
  if (!std::ranges::equal(board.image_flash().view(0).first(program.size()), program)) std::abort();
  return 0;
}
