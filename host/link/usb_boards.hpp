// Lists the boards on USB and opens one of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/link/hid_library.hpp"
#include "host/link/report_link.hpp"

namespace host {

struct UsbBoard {
  std::string serial_number;  ///< empty if libusb may not read it (no permission)
  std::string product;
  std::string path;  ///< hidapi's path of the device
};

/// Boards that are plugged in, whether or not this user may open them.
std::vector<UsbBoard> find_usb_boards(const HidLibrary& library = hid_library());

/// Opens the board with this serial number; if the number is empty, the only board. Throws Failure: no_such_device (no
/// board, none with this number, or several to choose from), permission (the message contains the udev rule and how to
/// install it).
std::unique_ptr<ReportLink> open_usb_board(const std::string& serial_number, const HidLibrary& library = hid_library());

}  // namespace host
