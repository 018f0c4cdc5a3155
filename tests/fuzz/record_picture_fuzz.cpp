// Any bytes as a long record: drawn in part and as a whole, or refused; its rows ascend and lie within the record.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "host/exit_codes.hpp"
#include "host/record/record_picture.hpp"

namespace {

/// A file in memory, with a path.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : file_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (file_ < 0 || ::write(file_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(file_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

void require(bool holds) {
  if (!holds) std::abort();
}

void read_all(const host::RecordFile& file) {
  for (std::size_t k = 0; k < file.blocks(); ++k) {
    std::uint64_t least = 0;
    file.each_row(file.block(k), [&](std::uint64_t number, std::span<const double> values) {
      require(number >= least && number < file.rows() && values.size() == file.columns().size());
      least = number;
    });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile memory(data, size);
  try {
    const host::RecordPicture picture(memory.path());
    const std::uint64_t rows = picture.file().rows();
    read_all(picture.file());
    picture.wait(10.0);
    picture.envelope(0, rows, 100);
    picture.envelope(rows / 2, rows / 2 + 10, 100);
    picture.text_of(rows / 3, rows / 2 + 1);
  } catch (const host::Failure&) {
  }
  return 0;
}
