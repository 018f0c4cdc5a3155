#include "host/link/usb_link.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "host/exit_codes.hpp"

namespace host {

namespace {

Failure gone(const std::string& name) {
  return {ExitCode::no_such_device, name + ": the board is gone; is it still plugged in?"};
}

}  // namespace

UsbLink::UsbLink(const HidLibrary& library, hid_device* device, const std::string& serial_number, std::string file)
    : library_(library), device_(device), name_("usb:" + serial_number), file_(std::move(file)), reader_([this] {
        read();
      }) {}

UsbLink::~UsbLink() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  reader_.join();
  library_.close(device_);
}

void UsbLink::send(const hal::HidReport& report) {
  std::array<unsigned char, 1 + hal::kHidReportSize> message{};  // the first byte is the report identifier: 0, unused
  std::memcpy(message.data() + 1, report.data(), report.size());
  if (library_.write(device_, message.data(), message.size()) < 0) throw gone(name_);
}

std::optional<hal::HidReport> UsbLink::receive(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  news_.wait_for(lock, limit, [this] { return !reports_.empty() || gone_; });
  if (reports_.empty() && gone_) throw gone(name_);
  if (reports_.empty()) return std::nullopt;
  const hal::HidReport report = reports_.front();
  reports_.pop_front();
  return report;
}

void UsbLink::read() {
  constexpr int kLookForStop_ms = 10;  // closing the link takes up to this time
  for (;;) {
    std::array<unsigned char, hal::kHidReportSize> buffer{};
    const int size = library_.read_timeout(device_, buffer.data(), buffer.size(), kLookForStop_ms);
    const std::lock_guard lock(mutex_);
    if (stop_) return;
    if (size < 0) gone_ = true;
    if (size > 0) std::memcpy(reports_.emplace_back().data(), buffer.data(), buffer.size());
    if (size != 0) news_.notify_all();
    if (gone_) return;
  }
}

}  // namespace host
