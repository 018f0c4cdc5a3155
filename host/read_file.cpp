#include "host/read_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "host/exit_codes.hpp"

namespace host {

namespace {
[[noreturn]] void fail(const std::string& path, int reason) {
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: cannot read: {}; check the name and its rights", path, std::strerror(reason)));
}
[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path, why));
}
}  // namespace

std::string read_file(const std::string& path, const ByteLimit& limit) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (!file) fail(path, errno);
  std::string text;
  constexpr std::size_t kBlock = std::size_t{1} << 20U;
  for (std::size_t line_begin = 0;;) {
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    const std::size_t got = std::fread(text.data() + before, 1, kBlock, file.get());
    text.resize(before + got);
    if (text.size() > limit.bytes)
      refuse(path,
             fmt::format("larger than {} MiB, the most that {} may have; cut it", limit.bytes / kMebibyte, limit.of));
    if (const std::size_t end = text.rfind('\n'); end != std::string::npos && end >= before) line_begin = end;
    if (limit.in_lines && text.size() - line_begin > kLongestLine)
      refuse(path, fmt::format("no text: a line is longer than {} MiB, the most that {} may have",
                               kLongestLine / kMebibyte, limit.of));
    if (got == kBlock) continue;
    if (std::ferror(file.get())) fail(path, errno);
    return text;
  }
}

std::string read_file(const std::string& path) { return read_file(path, kDocumentSize); }

}  // namespace host
