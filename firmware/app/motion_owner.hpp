// Ownership of motion and captures: only requests of the client that commanded a motion keep it going.
#pragma once

#include <cstdint>

namespace firmware {

/// Identification that a client chooses and writes into each of its requests. Replies repeat the lower 16 bits, which
/// every client sees, but never the 8 bits above them, its pass. See protocol/README.md.
using ClientToken = std::uint32_t;

/// Background only. While an axis moves, only the owner may command. An axis at rest belongs to the client that
/// commands it next.
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

/// A resource (a capture) that belongs to one client as long as its requests arrive. Times are in control periods.
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
