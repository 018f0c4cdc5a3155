// Converts text files from other systems to UTF-8.
#pragma once

#include <string>

namespace host {

/// Converts UTF-8 or UTF-16 to UTF-8 without byte-order mark. UTF-16 is recognised by its mark or by a zero byte beside
/// its first character. Bytes that are not UTF-8 are read as Windows-1252, which Western loggers write.
std::string as_utf8(std::string text);

}  // namespace host
