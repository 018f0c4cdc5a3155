// What the core's and the store's refusals are on the wire.
#pragma once

#include "firmware/app/protocol/messages.hpp"
#include "firmware/app/store/parameter_store.hpp"
#include "firmware/core/refusal.hpp"

namespace firmware {

/// Of a move or a node; a refused parameter has words of its own (RefusedValuePayload).
constexpr Status status_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return Status::ok;
    case Refusal::path_full:
      return Status::no_room;
    case Refusal::outside_travel:
      return Status::outside_travel;
    case Refusal::path_not_open:
      return Status::wrong_state;
    default:
      return Status::unreachable;
  }
}

constexpr Status status_of(SaveResult result) {
  return result == SaveResult::saved          ? Status::ok
         : result == SaveResult::not_verified ? Status::not_verified
                                              : Status::flash_failed;
}

}  // namespace firmware
