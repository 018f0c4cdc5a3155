// Whose motion it is: the client that commanded it, and nobody else, keeps it alive.
#pragma once

#include <cstdint>

namespace firmware {

/// The number that a client chose for itself and writes into each of its requests: protocol/README.md.
using ClientToken = std::uint16_t;

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

}  // namespace firmware
