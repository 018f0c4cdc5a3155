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
}  // namespace

std::string read_file(const std::string& path) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (!file) fail(path, errno);
  std::string text;
  constexpr std::size_t kBlock = std::size_t{1} << 20U;
  for (;;) {
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    const std::size_t got = std::fread(text.data() + before, 1, kBlock, file.get());
    text.resize(before + got);
    if (got == kBlock) continue;
    if (std::ferror(file.get())) fail(path, errno);
    return text;
  }
}

}  // namespace host
