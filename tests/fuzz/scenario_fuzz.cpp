// Any bytes as a scenario: read or refused with a message, never anything else.
#include <cstdint>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/hil/scenario.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    host::parse_scenario({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  } catch (const host::Failure&) {
    return 0;
  }
  return 0;
}
