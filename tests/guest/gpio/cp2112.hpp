// An emulated CP2112 (Silicon Labs, USB to eight GPIO lines and SMBus) on /dev/uhid: the kernel's driver hid-cp2112
// creates a real GPIO chip from it. Reports: Silicon Labs, AN495, chapter 4.
#pragma once

#include <linux/uhid.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

namespace guest_test {

class Cp2112 {
 public:
  struct Edge {
    unsigned line = 0;
    bool level = false;
    std::chrono::system_clock::time_point at;
  };

  /// `pulled_up`: one bit per line, its level while the line is an input. Throws std::runtime_error without /dev/uhid.
  explicit Cp2112(std::uint8_t pulled_up);
  Cp2112(const Cp2112&) = delete;
  Cp2112& operator=(const Cp2112&) = delete;
  ~Cp2112();

  /// /dev/gpiochipN, as soon as the driver has made it; throws std::runtime_error if it does not.
  std::filesystem::path chip() const;

  /// Whether the chip drives the line, high or low; else the pull-up alone holds it.
  bool drives(unsigned line) const { return (outputs_ >> line & 1) != 0; }

  /// Every change of level on the wires, oldest first.
  std::vector<Edge> edges() const;
  void forget_edges();

  /// Disconnects the chip; the destructor does so, too.
  void unplug();

 private:
  void serve();
  void answer_get(const uhid_event& request) const;
  void answer_set(const uhid_event& request);
  std::uint8_t levels() const;
  void note_edges(std::uint8_t before);

  int device_ = -1;
  int stop_event_ = -1;
  std::uint8_t pulled_up_ = 0;
  std::atomic<std::uint8_t> outputs_ = 0;  ///< GPIO configuration, direction: 1 is output
  std::uint8_t latch_ = 0;
  mutable std::mutex mutex_;
  std::vector<Edge> edges_;
  std::thread server_;
};

}  // namespace guest_test
