// Any text after --map is accepted or refused; a resulting column always depends on its source.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/import/mapping.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    for (const host::Mapping& mapping : host::parse_mappings({reinterpret_cast<const char*>(data), size}))
      if (mapping.column.empty() || mapping.source.empty() || mapping.factor == 0.0 || !std::isfinite(mapping.shift))
        std::abort();
  } catch (const host::Failure&) {
  }
  return 0;
}
