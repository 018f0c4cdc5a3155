// Maps refusals of core and store to statuses of replies.
#pragma once

#include "firmware/app/protocol/messages.hpp"
#include "firmware/app/store/parameter_store.hpp"
#include "firmware/core/refusal.hpp"

namespace firmware {

/// For a move or a node; a refused parameter has its own payload (RefusedValuePayload).
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
