// Link to a board through a Unix socket: the same 64-byte reports, one in each packet.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "host/link/report_link.hpp"

namespace host {

/// Owns a file descriptor and closes it.
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

/// Throws Failure(no_such_device) if no board listens at `path`, Failure(permission) if the user may not connect.
std::unique_ptr<ReportLink> connect_to_socket(const std::string& path);

/// Default socket of `axistool sim`: in the user's own runtime folder.
std::string default_socket_path();

/// A listening socket at `path`; replaces a socket that an ended program left there. Throws Failure(refused) if another
/// simulated board listens there, Failure(usage) if there is another kind of file.
OwnedDescriptor listen_at_socket(const std::string& path);

/// Removes the socket at `path`; leaves any other kind of file.
void remove_socket(const std::string& path);

}  // namespace host
