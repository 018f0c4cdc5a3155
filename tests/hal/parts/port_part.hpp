// A general-purpose port of sixteen pins. RM0090, chapter 8.
#pragma once

#include <array>
#include <functional>

#include "tests/hal/parts/bus.hpp"

namespace parts {

/// Level that the connected parts put on a pin.
enum class Outside { open, low, high };

/// Level that a pin puts on the connected parts.
enum class Drive { floating, pulled_up, pulled_down, low, high };

class PortPart : public Part {
 public:
  /// `letter` decides the values after reset: port A and B carry the debug port (8.3.1).
  PortPart(Bus& bus, char letter) : bus_(bus), letter_(letter) { reset(); }

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  void put(unsigned pin, Outside level) { outside_[pin] = level; }
  Drive drive(unsigned pin) const;
  /// Level that a part on this pin sees; a floating pin counts as low, and only inputs report it.
  bool level(unsigned pin) const;
  /// The alternate function (0 to 15) that the pin carries, -1 if it carries none.
  int function(unsigned pin) const;
  /// Longest time that an edge takes with 50 pF: datasheet, I/O AC characteristics.
  double edge_ns(unsigned pin) const {
    constexpr double kLongest_ns[4] = {100, 10, 6, 4};
    return kLongest_ns[bits(speed_, 2 * pin, 2)];
  }
  bool is_analogue(unsigned pin) const { return bits(mode_, 2 * pin, 2) == 3; }

  /// Called with the new drive of an output whenever it changes.
  std::array<std::function<void(Drive)>, 16> on_change;

 private:
  bool input(unsigned pin) const;
  void tell_changes();

  Bus& bus_;
  char letter_;
  std::uint32_t mode_ = 0, type_ = 0, speed_ = 0, pull_ = 0, output_ = 0;
  std::array<std::uint32_t, 2> function_{};
  std::array<Outside, 16> outside_{};
  std::array<Drive, 16> told_{};
};

}  // namespace parts
