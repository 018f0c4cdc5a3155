// A board at the other end of a Unix socket: the same 64-byte reports, one a packet.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "host/link/report_link.hpp"

namespace host {

/// A file descriptor that is closed once.
class OwnedDescriptor {
 public:
  explicit OwnedDescriptor(int descriptor = -1) : descriptor_(descriptor) {}
  OwnedDescriptor(OwnedDescriptor&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  OwnedDescriptor& operator=(OwnedDescriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~OwnedDescriptor();
  int get() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

/// Throws Failure(no_such_device) when nobody listens at `path`, Failure(permission) when the user may not.
std::unique_ptr<ReportLink> connect_to_socket(const std::string& path);

/// Default socket of `axistool sim`: in the user's own runtime folder.
std::string default_socket_path();

/// A listening socket; one that a program left behind at `path` is replaced. Throws Failure(refused) when another
/// simulated board listens there, Failure(usage) where another kind of file is.
OwnedDescriptor listen_at_socket(const std::string& path);

/// Removes the socket at `path`; leaves any other kind of file.
void remove_socket(const std::string& path);

}  // namespace host
