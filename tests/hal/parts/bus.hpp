// The chip's bus for the drivers under test: each access to a register arrives here, takes its time, and is answered by
// the part at that address. Parts are written from their manuals and never include the drivers' headers.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace parts {

/// Thrown by the processor's last access.
struct ChipReset : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Part {
 public:
  Part() = default;
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;
  virtual ~Part() = default;

  /// `offset` in bytes from the part's base. run() has been called up to this time.
  virtual std::uint32_t read(std::uint32_t offset) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value) = 0;
  /// Advances the part's own time until now.
  virtual void run(double /*now_ns*/) {}
  /// Resets the part, as a reset of the chip or the part's bit in the reset registers does.
  virtual void reset() = 0;
};

/// Only the newest bus answers accesses.
class Bus {
 public:
  Bus();
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  static Bus& current();

  /// While `is_clocked` returns false, reads give 0 and writes are lost (RM0090, 7.3.10), and the part's time
  /// does not advance.
  void attach(std::uintptr_t base, std::uint32_t size, Part& part, std::function<bool()> is_clocked = {});

  std::uint32_t read(std::uintptr_t address, std::size_t size);
  void write(std::uintptr_t address, std::size_t size, std::uint32_t value);

  /// A read by another master of the bus: it takes the processor no time.
  std::uint32_t read_by_dma(std::uintptr_t address);

  double now_ns() const { return now_ns_; }
  /// Time passes while the processor does something else.
  void pass_ns(double time_ns);
  void pass_ms(double time_ms) { pass_ns(1e6 * time_ms); }

  /// The processor runs this as soon as possible: between two accesses, not within another interrupt, not while
  /// interrupts are disabled. An interrupt that is already pending runs once.
  void interrupt(unsigned number, const std::function<void()>& handler);
  void shut_out(bool begins);

  /// Time that an access takes: four processor clocks, load or store and the bridge to a peripheral bus.
  void set_processor_clock(double clock_Hz) { access_ns_ = 4e9 / clock_Hz; }

  /// Reports an access that the manuals do not allow. Tests check at their end that there was no such access.
  void complain(const std::string& what);
  const std::vector<std::string>& complaints() const { return complaints_; }
  /// Returns and clears the complaints so far.
  std::vector<std::string> take_complaints();

 private:
  struct Place {
    std::uintptr_t base;
    std::uint32_t size;
    Part* part;
    std::function<bool()> is_clocked;
  };
  const Place& at(std::uintptr_t address) const;
  void take_interrupts();

  std::vector<Place> places_;
  double now_ns_ = 0.0;
  double access_ns_ = 250.0;  // 16 MHz
  std::map<unsigned, std::function<void()>> pending_;
  int shut_out_ = 0, passing_ = 0;
  bool interrupted_ = false;
  std::vector<std::string> complaints_;
};

/// Registers without behaviour.
class PlainRegisters : public Part {
 public:
  std::uint32_t read(std::uint32_t offset) override { return words_.at(offset / 4); }
  void write(std::uint32_t offset, std::uint32_t value) override { words_.at(offset / 4) = value; }
  void reset() override { words_.assign(words_.size(), 0); }

  explicit PlainRegisters(std::uint32_t size) : words_(size / 4) {}

 private:
  std::vector<std::uint32_t> words_;
};

/// The debug unit's cycle counter (ARMv7-M ARM, C1.8.7 and C1.8.8): counts while it and the trace unit are on.
class CyclePart : public Part {
 public:
  /// `trace_is_on`: DEMCR.TRCENA.
  CyclePart(std::function<double()> clock_Hz, std::function<bool()> trace_is_on)
      : clock_Hz_(std::move(clock_Hz)), trace_is_on_(std::move(trace_is_on)) {}

  std::uint32_t read(std::uint32_t offset) override {
    if (offset == 0) return trace_is_on_() ? control_ : 0;
    return offset == 4 ? static_cast<std::uint32_t>(static_cast<std::int64_t>(cycles_)) : 0;
  }
  void write(std::uint32_t offset, std::uint32_t value) override {
    if (!trace_is_on_()) return;
    if (offset == 0) control_ = value;
    if (offset == 4) cycles_ = value;
  }
  void run(double now_ns) override {
    if (trace_is_on_() && (control_ & 1u) != 0) cycles_ += (now_ns - ran_until_ns_) * 1e-9 * clock_Hz_();
    ran_until_ns_ = now_ns;
  }
  void reset() override { control_ = 0; }

 private:
  std::function<double()> clock_Hz_;
  std::function<bool()> trace_is_on_;
  std::uint32_t control_ = 0;
  double cycles_ = 0.0, ran_until_ns_ = 0.0;
};

/// Bits `first` and up of a register.
constexpr std::uint32_t bits(std::uint32_t value, unsigned first, unsigned count = 1) {
  return value >> first & ((1u << count) - 1);
}

}  // namespace parts
