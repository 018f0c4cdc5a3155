// Access control of the workbench: accepts only requests of its own pages, on this computer, with its token.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace host::workbench {

/// 128 random bits in hexadecimal. Throws Failure(permission) where the system gives none.
std::string random_token();

/// A web page that is open in the same browser can send requests to this computer too: under another name that resolves
/// to it (Host), or from another origin. Neither has the cookie, so both are refused.
class Access {
 public:
  Access(std::string token, int port) : token_(std::move(token)), port_(port) {}

  std::string url() const;  ///< with the token: what the user opens
  /// The cookie that keeps the token: not accessible to scripts or other sites.
  std::string cookie() const;

  bool is_own_host(std::string_view host) const;
  /// A request without origin comes from a program that is not a browser; it needs the cookie as well.
  bool is_own_origin(std::string_view origin) const;
  bool is_token(std::string_view text) const;  ///< takes equally long for a wrong token
  bool has_cookie(std::string_view cookies) const;

 private:
  std::string cookie_name() const;  ///< by port: cookies are shared by all ports of a host

  std::string token_;
  int port_;
};

}  // namespace host::workbench
