// Access control of the workbench: accepts only requests from its own pages on this computer, with its token.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace host::workbench {

/// 128 random bits in hexadecimal. Throws Failure(permission) if the system provides none.
std::string random_token();

/// Another web page in the same browser can also send requests to this computer: with another host name that resolves
/// to it, or from another origin. Such requests lack the cookie and are refused.
class Access {
 public:
  Access(std::string token, int port) : token_(std::move(token)), port_(port) {}

  std::string url() const;  ///< address for the user, with the token
  /// The cookie that keeps the token: not accessible to scripts or other sites.
  std::string cookie() const;

  bool is_own_host(std::string_view host) const;
  /// A request without origin comes from a program that is not a browser; it needs the cookie as well.
  bool is_own_origin(std::string_view origin) const;
  bool is_token(std::string_view text) const;  ///< takes constant time, also for a wrong token
  bool has_cookie(std::string_view cookies) const;

 private:
  std::string cookie_name() const;  ///< contains the port, because all ports of a host share cookies

  std::string token_;
  int port_;
};

}  // namespace host::workbench
