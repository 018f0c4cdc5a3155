// Any bytes as a controller's log: recognised channels and records that can be written, or a refusal.
#include <cstdint>
#include <string>

#include "host/exit_codes.hpp"
#include "host/opening/mapping_file.hpp"
#include "host/opening/understanding.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    host::Log log =
        bytes.starts_with("PK") ? host::parse_npz(bytes, "fuzz.npz") : host::parse_log_text(bytes, "fuzz.csv");
    host::decode_signs(log);
    host::understand(log, {&log}, {});
  } catch (const host::Failure&) {
  }
  try {
    host::parse_mapping_file(bytes, "fuzz.toml");
  } catch (const host::Failure&) {
  }
  return 0;
}
