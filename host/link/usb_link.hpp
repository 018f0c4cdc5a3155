// Link to one board over USB.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "host/link/hid_library.hpp"
#include "host/link/report_link.hpp"

namespace host {

class UsbLink : public ReportLink {
 public:
  /// Takes ownership of `device`, which `library` has opened.
  UsbLink(const HidLibrary& library, hid_device* device, const std::string& serial_number, std::string file = "");
  ~UsbLink() override;

  void send(const hal::HidReport& report) override;
  std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override;
  std::string name() const override { return name_; }
  std::string file() const override { return file_; }

 private:
  void read();

  const HidLibrary& library_;
  hid_device* device_;
  std::string name_, file_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<hal::HidReport> reports_;
  bool gone_ = false;
  bool stop_ = false;
  std::thread reader_;  // last member, because it uses the others
};

}  // namespace host
