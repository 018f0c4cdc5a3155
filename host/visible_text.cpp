#include "host/visible_text.hpp"

#include <fmt/format.h>

namespace host {

std::string visible_text(std::string_view text) {
  std::string shown;
  for (const char c : text)
    if (c >= ' ' && c <= '~' && c != '\\')
      shown += c;
    else
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return shown;
}

}  // namespace host
