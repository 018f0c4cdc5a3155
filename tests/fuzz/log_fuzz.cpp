// Any bytes as a controller's log, and as a message of joint states: recognised channels and records that can be
// written, or a refusal.
#include <cstdint>
#include <string>

#include "host/exit_codes.hpp"
#include "host/import/joint_states.hpp"
#include "host/opening/mapping_file.hpp"
#include "host/opening/understanding.hpp"

namespace {

host::Log log_of(std::string_view bytes) {
  if (!bytes.starts_with(std::string_view("\0", 1))) return host::parse_log(bytes, "fuzz");
  host::JointStates joints("fuzz");
  joints.add("/a", bytes, 1);
  joints.add(bytes.size() % 2 == 0 ? "/a" : "/b", bytes, -1);
  return joints.log({});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    host::Log log = log_of(bytes);
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
