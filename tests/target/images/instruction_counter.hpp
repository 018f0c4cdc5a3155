// Counts executed instructions: with QEMU's -icount shift=0 an instruction takes 1 ns, and TIM2 counts ns.
#pragma once

#include <cstdint>

#include "firmware/boards/image/text_writer.hpp"
#include "hal/qemu/semihosting.hpp"
#include "hal/stm32f4/registers.hpp"

namespace target_image {

inline std::uint32_t instructions() { return hal::stm32f4::timer2().CNT; }

inline void start_counting() {
  hal::stm32f4::Timer& timer = hal::stm32f4::timer2();
  timer.PSC = 0;
  timer.ARR = 0xFFFFFFFF;
  timer.EGR = hal::stm32f4::Timer::kUpdate;
  timer.CR1 = hal::stm32f4::Timer::kEnable;
}

/// Instructions that `work` executes, without those for counting.
template <typename Work>
[[gnu::noinline]] std::uint32_t count(Work&& work) {
  const std::uint32_t before = instructions();
  asm volatile("" ::: "memory");
  work();
  asm volatile("" ::: "memory");
  const std::uint32_t between = instructions();
  asm volatile("" ::: "memory");
  const std::uint32_t after = instructions();
  return (between - before) - (after - between);
}

/// Mean and worst of many counts.
class Cost {
 public:
  void add(std::uint32_t instruction_count) {
    sum_ += instruction_count;
    ++number_;
    if (instruction_count > worst_) worst_ = instruction_count;
  }
  std::uint32_t mean() const { return number_ == 0 ? 0 : (sum_ + number_ / 2) / number_; }
  std::uint32_t worst() const { return worst_; }

 private:
  std::uint32_t sum_ = 0, number_ = 0, worst_ = 0;
};

struct EmulatorPort {
  void send(std::byte byte) {
    const char text[2] = {static_cast<char>(byte), '\0'};
    hal::qemu::print(text);
  }
  bool receive(std::byte&) { return false; }
};
static_assert(hal::SerialPort<EmulatorPort>);

/// One line a result: cost NAME MEAN WORST.
inline void report(const char* name, const Cost& cost) {
  EmulatorPort port;
  firmware::boards::TextWriter(port) << "cost " << name << " " << cost.mean() << " " << cost.worst() << "\n";
}

}  // namespace target_image
