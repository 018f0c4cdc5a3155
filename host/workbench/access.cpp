#include "host/workbench/access.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>

#include "host/exit_codes.hpp"

namespace host::workbench {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Failure(ExitCode::permission, "the system provides no random numbers for a token");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

std::string Access::url() const { return fmt::format("http://127.0.0.1:{}/?token={}", port_, token_); }

std::string Access::cookie_name() const { return fmt::format("axistool-{}", port_); }

std::string Access::cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name(), token_);
}

bool Access::is_own_host(std::string_view host) const {
  return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
}

bool Access::is_own_origin(std::string_view origin) const {
  constexpr std::string_view kScheme = "http://";
  return origin.empty() || (origin.starts_with(kScheme) && is_own_host(origin.substr(kScheme.size())));
}

bool Access::is_token(std::string_view text) const {
  unsigned differing = text.size() == token_.size() ? 0U : 1U;
  for (std::size_t k = 0; k < token_.size(); ++k)
    differing |= static_cast<unsigned char>(token_[k]) ^ static_cast<unsigned char>(k < text.size() ? text[k] : '\0');
  return differing == 0U;
}

bool Access::has_cookie(std::string_view cookies) const {
  const std::string begin = cookie_name() + "=";
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    const std::string_view one = cookies.substr(0, end);
    if (one.starts_with(begin) && is_token(one.substr(begin.size()))) return true;
    cookies.remove_prefix(std::min(cookies.size(), end + 1));
    cookies.remove_prefix(std::min(cookies.size(), cookies.find_first_not_of(' ')));
  }
  return false;
}

}  // namespace host::workbench
