#include "host/link/usb_boards.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

#include "hal/usb_identity.hpp"
#include "host/exit_codes.hpp"
#include "host/link/device_users.hpp"
#include "host/link/udev_rule.hpp"
#include "host/link/usb_link.hpp"

namespace host {

namespace {

/// hidapi's texts are wide; the board's are ASCII.
std::string narrow(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != L'\0'; ++text) result += *text < 0x80 ? static_cast<char>(*text) : '?';
  return result;
}

/// Whether the device is a board; libusb does not report usage page and usage.
bool is_board(const hid_device_info& found) {
  return found.interface_number <= hal::kUsbInterface &&
         (found.usage_page == 0 || (found.usage_page == hal::kHidUsagePage && found.usage == hal::kHidUsage));
}

/// The device file behind hidapi's path, on which the permission depends: /dev/hidrawN, or for libusb's 1-2:1.0 the
/// file of USB device 1-2.
std::string device_file(const std::string& path) {
  if (path.rfind("/dev/", 0) == 0) return path;
  const std::string folder = "/sys/bus/usb/devices/" + path.substr(0, path.find(':'));
  int bus = 0, device = 0;
  std::ifstream(folder + "/busnum") >> bus;
  std::ifstream(folder + "/devnum") >> device;
  return fmt::format("/dev/bus/usb/{:03}/{:03}", bus, device);
}

[[noreturn]] void explain_open(const UsbBoard& board) {
  const std::string file = device_file(board.path);
  if (access(file.c_str(), R_OK | W_OK) != 0 && errno == EACCES)
    throw Failure(ExitCode::permission,
                  fmt::format("{} may not be opened by this user. Install the udev rule: {}\nwhich writes to {}:\n{}",
                              file, kInstallUdevRule, kUdevRuleFile, udev_rule()));
  throw Failure(ExitCode::no_such_device,
                fmt::format("{} cannot be opened; is the board still plugged in{}", file,
                            other_users(file).empty() ? ", does another program use it?" : "?" + other_users(file)));
}

const UsbBoard& choose(const std::vector<UsbBoard>& boards, const std::string& serial_number) {
  if (boards.empty())
    throw Failure(ExitCode::no_such_device,
                  "no board on USB: plug one in and power it, or start `axistool sim` and give --device sim");
  std::vector<std::string> present;
  for (const UsbBoard& board : boards) {
    if (!serial_number.empty() && board.serial_number == serial_number) return board;
    present.push_back("usb:" + board.serial_number);
  }
  if (!serial_number.empty())
    throw Failure(ExitCode::no_such_device,
                  fmt::format("no board usb:{} on USB; there is: {}", serial_number, fmt::join(present, ", ")));
  if (boards.size() > 1)
    throw Failure(ExitCode::no_such_device,
                  fmt::format("{} boards on USB; choose one by --device: {}", boards.size(), fmt::join(present, ", ")));
  return boards.front();
}

}  // namespace

std::vector<UsbBoard> find_usb_boards(const HidLibrary& library) {
  std::vector<UsbBoard> boards;
  hid_device_info* found = library.enumerate(hal::kUsbVendor, hal::kUsbProduct);
  for (const hid_device_info* one = found; one != nullptr; one = one->next)
    if (is_board(*one)) boards.push_back({narrow(one->serial_number), narrow(one->product_string), one->path});
  library.free_enumeration(found);
  return boards;
}

std::unique_ptr<ReportLink> open_usb_board(const std::string& serial_number, const HidLibrary& library) {
  const std::vector<UsbBoard> boards = find_usb_boards(library);
  // Without permission libusb cannot read serial numbers. Then opening the only board gives the error message.
  const bool unreadable = boards.size() == 1 && boards.front().serial_number.empty();
  const UsbBoard& board = unreadable ? boards.front() : choose(boards, serial_number);
  hid_device* device = library.open_path(board.path.c_str());
  if (device == nullptr) explain_open(board);
  return std::make_unique<UsbLink>(library, device, board.serial_number, device_file(board.path));
}

}  // namespace host
