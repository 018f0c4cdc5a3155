#include "tests/guest/gpio/cp2112.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace guest_test {

namespace {

constexpr std::uint32_t kVendor = 0x10C4, kProduct = 0xEA90;
constexpr const char* kSysfs = "/sys/devices/virtual/misc/uhid";

// AN495, table 4.1: identifiers of the reports.
constexpr std::uint8_t kGpioConfiguration = 0x02, kGetGpio = 0x03, kSetGpio = 0x04, kVersion = 0x05,
                       kSmbusConfiguration = 0x06, kLock = 0x20;

/// The part of the chip's report descriptor that the driver needs: identifiers and lengths. One byte per element,
/// vendor page.
constexpr std::array<std::uint8_t, 71> kReportDescriptor{0x06, 0x00,
                                                         0xFF, 0x09,
                                                         0x01, 0xA1,
                                                         0x01,  // usage page vendor, usage 1, collection
                                                         0x15, 0x00,
                                                         0x26, 0xFF,
                                                         0x00, 0x75,
                                                         0x08,  // 0 to 255, 8 bits
                                                         0x85, kGpioConfiguration,
                                                         0x95, 4,
                                                         0x09, 0x01,
                                                         0xB1, 0x02,  // feature
                                                         0x85, kGetGpio,
                                                         0x95, 1,
                                                         0x09, 0x01,
                                                         0xB1, 0x02,  //
                                                         0x85, kSetGpio,
                                                         0x95, 2,
                                                         0x09, 0x01,
                                                         0xB1, 0x02,  //
                                                         0x85, kVersion,
                                                         0x95, 2,
                                                         0x09, 0x01,
                                                         0xB1, 0x02,  //
                                                         0x85, kSmbusConfiguration,
                                                         0x95, 13,
                                                         0x09, 0x01,
                                                         0xB1, 0x02,  //
                                                         0x85, kLock,
                                                         0x95, 1,
                                                         0x09, 0x01,
                                                         0xB1, 0x02,  //
                                                         0x85, 0x10,
                                                         0x95, 63,
                                                         0x09, 0x01,
                                                         0x91, 0x02,  // SMBus request: output
                                                         0xC0};

void write_event(int device, const uhid_event& event) {
  if (write(device, &event, sizeof event) < 0) throw std::runtime_error(std::string("uhid: ") + std::strerror(errno));
}

}  // namespace

Cp2112::Cp2112(std::uint8_t pulled_up) : pulled_up_(pulled_up) {
  device_ = open("/dev/uhid", O_RDWR | O_CLOEXEC);
  stop_event_ = eventfd(0, EFD_CLOEXEC);
  if (device_ < 0 || stop_event_ < 0) throw std::runtime_error(std::string("/dev/uhid: ") + std::strerror(errno));
  uhid_event create{};
  create.type = UHID_CREATE2;
  constexpr std::string_view kName = "CP2112";
  std::copy(kName.begin(), kName.end(), create.u.create2.name);
  create.u.create2.rd_size = kReportDescriptor.size();
  std::copy(kReportDescriptor.begin(), kReportDescriptor.end(), create.u.create2.rd_data);
  create.u.create2.bus = 3;  // USB: linux/input.h
  create.u.create2.vendor = kVendor;
  create.u.create2.product = kProduct;
  write_event(device_, create);
  server_ = std::thread([this] { serve(); });
}

Cp2112::~Cp2112() {
  unplug();
  close(stop_event_);
}

void Cp2112::unplug() {
  if (device_ < 0) return;
  const std::uint64_t one = 1;
  if (write(stop_event_, &one, sizeof one) == sizeof one) server_.join();
  close(device_);
  device_ = -1;
}

std::filesystem::path Cp2112::chip() const {
  namespace fs = std::filesystem;
  for (int attempt = 0; attempt < 200; ++attempt) {
    std::error_code absent;
    for (const auto& hid : fs::directory_iterator(kSysfs, absent)) {
      if (hid.path().filename().string().find("10C4:EA90") == std::string::npos) continue;
      for (const auto& entry : fs::directory_iterator(hid.path(), absent)) {
        const std::string name = entry.path().filename();
        if (name.rfind("gpiochip", 0) == 0 && fs::exists("/dev/" + name)) return "/dev/" + name;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error("hid-cp2112 makes no GPIO chip");
}

std::vector<Cp2112::Edge> Cp2112::edges() const {
  const std::lock_guard lock(mutex_);
  return edges_;
}

void Cp2112::forget_edges() {
  const std::lock_guard lock(mutex_);
  edges_.clear();
}

std::uint8_t Cp2112::levels() const {
  return static_cast<std::uint8_t>((latch_ & outputs_) | (pulled_up_ & ~outputs_));
}

void Cp2112::note_edges(std::uint8_t before) {
  const auto now = std::chrono::system_clock::now();
  const unsigned changed = before ^ levels();
  const std::lock_guard lock(mutex_);
  for (unsigned line = 0; line < 8; ++line)
    if ((changed >> line & 1u) != 0) edges_.push_back({line, (levels() >> line & 1) != 0, now});
}

void Cp2112::serve() {
  for (;;) {
    std::array<pollfd, 2> waiting{pollfd{device_, POLLIN, 0}, pollfd{stop_event_, POLLIN, 0}};
    if (poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
    if (waiting[1].revents != 0) return;
    uhid_event request{};
    if (waiting[0].revents == 0) continue;
    if (read(device_, &request, sizeof request) <= 0) return;
    if (request.type == UHID_GET_REPORT) answer_get(request);
    if (request.type == UHID_SET_REPORT) answer_set(request);
  }
}

void Cp2112::answer_get(const uhid_event& request) const {
  uhid_event reply{};
  reply.type = UHID_GET_REPORT_REPLY;
  auto& answer = reply.u.get_report_reply;
  answer.id = request.u.get_report.id;
  answer.data[0] = request.u.get_report.rnum;
  switch (request.u.get_report.rnum) {
    case kGpioConfiguration:
      answer.data[1] = outputs_;
      answer.data[2] = outputs_;  // push-pull
      answer.size = 5;
      break;
    case kGetGpio:
      answer.data[1] = levels();
      answer.size = 2;
      break;
    case kVersion:
      answer.data[1] = 0x0C;  // part number of the CP2112
      answer.data[2] = 2;
      answer.size = 3;
      break;
    case kSmbusConfiguration:
      answer.size = 14;
      break;
    case kLock:
      answer.size = 2;
      break;
    default:
      answer.err = EIO;
  }
  write_event(device_, reply);
}

void Cp2112::answer_set(const uhid_event& request) {
  const auto& report = request.u.set_report;
  const std::uint8_t before = levels();
  if (report.rnum == kGpioConfiguration && report.size >= 5) outputs_ = report.data[1];
  if (report.rnum == kSetGpio && report.size >= 3)
    latch_ = static_cast<std::uint8_t>((latch_ & ~report.data[2]) | (report.data[1] & report.data[2]));
  note_edges(before);
  uhid_event reply{};
  reply.type = UHID_SET_REPORT_REPLY;
  reply.u.set_report_reply.id = report.id;
  write_event(device_, reply);
}

}  // namespace guest_test
