// Any bytes as a model file: read or refused; a model that was read survives writing.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  sim::DriveDescription model;
  try {
    model = host::parse_drive(bytes, "fuzz.toml");
  } catch (const host::Failure&) {
    return 0;
  }
  const std::string text = host::format_model(model);
  if (host::format_model(host::parse_drive(text, "again.toml")) != text) std::abort();
  return 0;
}
