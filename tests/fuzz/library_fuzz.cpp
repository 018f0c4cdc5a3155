// Files that external libraries read (MATLAB, HDF5, SQLite), in a separate process: channels or a refusal; the file is
// unchanged.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/exit_codes.hpp"
#include "host/opening/understanding.hpp"
#include "host/read_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (!bytes.starts_with("MATLAB ") && !bytes.starts_with("\x89HDF") && !bytes.starts_with("SQLite format 3")) return 0;
  static const std::string path =
      (std::filesystem::temp_directory_path() / ("axis-fuzz-" + std::to_string(getpid()))).string();
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    host::Log log = host::read_log(path);
    host::decode_signs(log);
    host::understand(log, {&log}, {});
  } catch (const host::Failure&) {
  }
  if (host::read_file(path, host::kLogSize) != bytes) std::abort();
  std::filesystem::remove(path);
  return 0;
}
