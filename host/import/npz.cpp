// Archives of NumPy arrays (numpy.savez): a ZIP file with uncompressed .npy files (APPNOTE.TXT 4.3).
#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/import/log_file.hpp"

namespace host {

namespace {

[[noreturn]] void refuse_archive(std::string_view path, const std::string& what) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path, what));
}

class ZipReader {
 public:
  ZipReader(std::string_view bytes, std::string_view path) : bytes_(bytes), path_(path) {}

  Log read() {
    Log log;
    log.path = path_;
    log.layout = "npz";
    find_directory();
    for (std::size_t k = 0; k < members_; ++k) add_member(log);
    if (log.columns.empty())
      refuse_archive(path_, "a packed archive without NumPy arrays; save the arrays with numpy.savez");
    return log;
  }

 private:
  std::string_view part(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || bytes_.size() - at < size) refuse_archive(path_, "the archive is cut off; save it again");
    return bytes_.substr(at, size);
  }

  std::size_t number(std::size_t at, std::size_t size) const {
    const std::string_view raw = part(at, size);
    std::size_t value = 0;
    for (std::size_t k = 0; k < raw.size(); ++k)
      value += static_cast<std::size_t>(static_cast<unsigned char>(raw[k])) << (8 * k);
    return value;
  }

  /// The directory is at the end of the file, followed by its position.
  void find_directory() {
    const std::size_t end = bytes_.rfind("PK\x05\x06");
    if (end == std::string_view::npos) refuse_archive(path_, "the archive is cut off; save it again");
    members_ = number(end + 10, 2);
    at_ = number(end + 16, 4);
  }

  void add_member(Log& log) {
    constexpr std::size_t kEntry = 46, kLocal = 30;
    const std::size_t method = number(at_ + 10, 2), packed = number(at_ + 20, 4), length = number(at_ + 28, 2);
    const std::size_t extra = number(at_ + 30, 2), comment = number(at_ + 32, 2), local = number(at_ + 42, 4);
    std::string_view name = part(at_ + kEntry, length);
    at_ += kEntry + length + extra + comment;
    if (!name.ends_with(".npy")) return;
    name.remove_suffix(4);
    if (method != 0)
      refuse_archive(
          path_, fmt::format("'{}' is compressed; save the arrays with numpy.savez instead of savez_compressed", name));
    const std::size_t begin = local + kLocal + number(local + 26, 2) + number(local + 28, 2);
    const std::string_view array = part(begin, packed);
    taken_ += packed;
    if (taken_ > bytes_.size()) refuse_archive(path_, "the members of the archive overlap; save it again");
    add_array(array, name, log);
  }

  /// Members without rows of numbers (texts, single values) are left out.
  void add_array(std::string_view array, std::string_view name, Log& log) const {
    Log part;
    try {
      part = parse_npy(array, fmt::format("{}({})", path_, name));
    } catch (const Failure&) {
      log.header["imported_without"] += fmt::format("{} ", name);
      return;
    }
    const bool is_single = part.columns.size() == 1;
    for (std::size_t k = 0; k < part.columns.size(); ++k) {
      LogColumn& column = part.columns[k];
      column.name = column.name.empty() ? (is_single ? std::string(name) : fmt::format("{}({})", name, k + 1))
                                        : fmt::format("{}.{}", name, column.name);
      log.columns.push_back(std::move(column));
    }
  }

  std::string_view bytes_, path_;
  std::size_t members_ = 0, at_ = 0, taken_ = 0;
};

}  // namespace

Log parse_npz(std::string_view bytes, std::string_view path) { return ZipReader(bytes, path).read(); }

}  // namespace host
