// Lists the boards on this computer's USB, and opens one of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/link/hid_library.hpp"
#include "host/link/report_link.hpp"

namespace host {

struct UsbBoard {
  std::string serial_number;  ///< empty if only the board's owner may read it (libusb without permission)
  std::string product;
  std::string path;  ///< hidapi's name for it
};

/// Boards that are plugged in, whether or not this user may open them.
std::vector<UsbBoard> find_usb_boards(const HidLibrary& library = hid_library());

/// Opens the board with this serial number; if the number is empty, the only board. Throws Failure: no_such_device (no
/// board, none with this number, or several to choose from), permission (the message has the udev rule and how to
/// install it).
std::unique_ptr<ReportLink> open_usb_board(const std::string& serial_number, const HidLibrary& library = hid_library());

}  // namespace host
