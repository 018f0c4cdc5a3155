// Any bytes as replies of a board: every request of the host ends with a result or a named failure.
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "host/device/board_client.hpp"
#include "host/device/fault_log.hpp"
#include "host/device/image_update.hpp"
#include "host/exit_codes.hpp"
#include "host/simulated_board/simulated_image.hpp"

namespace {

/// Answers with the input, 64 bytes at a time. The first byte of each piece selects corrections, so that the fuzzer
/// passes the checks: checksum, sequence number and type.
class FuzzedLink : public host::ReportLink {
 public:
  FuzzedLink(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  void send(const hal::HidReport& report) override { asked_ = report; }

  std::optional<hal::HidReport> receive(std::chrono::milliseconds) override {
    if (size_ < 1 + hal::kHidReportSize) return std::nullopt;
    hal::HidReport report;
    const std::uint8_t truth = data_[0];
    std::memcpy(report.data(), data_ + 1, report.size());
    data_ += 1 + report.size();
    size_ -= 1 + report.size();
    if ((truth & 1) != 0) report[0] = std::byte{firmware::kProtocolVersion};
    if ((truth & 2) != 0) {
      report[1] = asked_[1] | std::byte{firmware::kReplyBit};
      report[2] = asked_[2];
      report[3] = asked_[3];
      report[6] = asked_[6];
      report[7] = asked_[7];
    }
    if ((truth & 4) != 0) report[4] = std::byte{0};
    if ((truth & 8) != 0) {
      const std::uint32_t crc = firmware::crc32(std::span(report).first(firmware::kCrcOffset));
      std::memcpy(report.data() + firmware::kCrcOffset, &crc, sizeof crc);
    }
    return report;
  }

  std::string name() const override { return "fuzz"; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  hal::HidReport asked_{};
};

host::ImageFile sample_file() {
  const std::vector<std::byte> image = host::simulated_image("fuzz");
  return host::parse_image_file({reinterpret_cast<const char*>(image.data()), image.size()}, "fuzz");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  host::BoardClient board(std::make_unique<FuzzedLink>(data + 1, size - 1));
  try {
    switch (data[0] % 11) {
      case 0:
        board.require_same_table();
        break;
      case 1:
        board.status();
        break;
      case 2:
        board.timing(true);
        break;
      case 3:
        board.read_values();
        break;
      case 4:
        board.write_values(firmware::ParameterValues{});
        break;
      case 5:
        board.read_stored();
        break;
      case 6:
        board.fault_row(0, 0);
        break;
      case 8:
        host::fault_log_text(board.fault_log(), nullptr);
        break;
      case 9:
        if (const auto seen = host::read_slots(board)) {
          host::slots_text(*seen);
          host::slots_json(*seen).dump();
        }
        break;
      case 10:
        host::send_image(board, sample_file(), [](std::size_t, std::size_t) {});
        host::confirm_image(board);
        break;
      default:
        board.start_capture({});
        while (board.next_samples(std::chrono::milliseconds(1))) continue;
        board.stop_capture();
    }
  } catch (const host::Failure&) {
  }
  return 0;
}
