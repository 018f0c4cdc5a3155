// The clock for TinyUSB's delays on a computer. No function of this project calls them, but without optimisation the
// linker keeps them.
#include <tusb.h>

#include <chrono>

extern "C" std::uint32_t tusb_time_millis_api(void) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}
