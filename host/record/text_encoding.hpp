// Converts text files of other systems to UTF-8.
#pragma once

#include <string>

namespace host {

/// UTF-8 without byte-order mark, of UTF-8 or UTF-16 (known by its mark, or by a zero byte beside its first character).
/// Bytes that are not UTF-8 are taken as Windows-1252, which Western loggers write.
std::string as_utf8(std::string text);

}  // namespace host
