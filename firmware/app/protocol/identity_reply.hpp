// Makes a board's reply to identify.
#pragma once

#include <algorithm>
#include <type_traits>

#include "firmware/app/image_header.hpp"
#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/app/protocol/messages.hpp"

namespace firmware {

template <typename Application>
IdentityPayload identity_of(const ImageHeader& image) {
  IdentityPayload payload;
  payload.schema_hash = kSchemaHash;
  payload.parameter_count = static_cast<std::uint16_t>(parameter_count(Application::kAxes));
  payload.axis_count = Application::kAxes;
  payload.fixed_point = std::is_same_v<typename Application::Number, float> ? 0 : 1;
  payload.board = image.board;
  payload.version = image.version;
  std::copy_n(image.git_hash.begin(), payload.git_hash.size(), payload.git_hash.begin());
  return payload;
}

}  // namespace firmware
