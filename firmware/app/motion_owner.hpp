// Whose motion and whose capture it is: the client that commanded it, and nobody else, keeps it alive.
#pragma once

#include <cstdint>

namespace firmware {

/// What a client chose for itself and writes into each of its requests: the lower 16 bits come back in replies, which
/// everybody sees; the 8 above them, its pass, never do. protocol/README.md.
using ClientToken = std::uint32_t;

/// Background only. While an axis moves, only the owner commands; an axis at rest belongs to whoever commands it next.
class MotionOwner {
 public:
  constexpr bool is(ClientToken client) const { return is_known_ && client == client_; }
  constexpr bool may_command(ClientToken client, bool in_motion) const {
    return !in_motion || !is_known_ || client == client_;
  }
  constexpr void become(ClientToken client) {
    client_ = client;
    is_known_ = true;
  }

 private:
  ClientToken client_ = 0;
  bool is_known_ = false;
};

/// Something that one client uses while it is heard now and then: a capture. Times are control periods.
class ClientClaim {
 public:
  constexpr void take(ClientToken client, std::uint32_t now) {
    client_ = client;
    heard_at_ = now;
    is_held_ = true;
  }
  constexpr void release() { is_held_ = false; }
  constexpr void hear(ClientToken client, std::uint32_t now) {
    if (client == client_) heard_at_ = now;
  }
  constexpr bool is_others(ClientToken client, std::uint32_t now, std::uint32_t patience) const {
    return is_held_ && client != client_ && now - heard_at_ <= patience;
  }
  constexpr ClientToken client() const { return client_; }

 private:
  ClientToken client_ = 0;
  std::uint32_t heard_at_ = 0;
  bool is_held_ = false;
};

}  // namespace firmware
