// Images for the simulated board, to try updates. The board always runs the present program, whatever the image
// contains.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace host {

/// An image of this version hangs on the simulated board, so that the watchdog resets the board.
inline constexpr std::string_view kHangingVersion = "hangs";

/// A complete image of 4 KB. Throws Failure(usage) if the version is empty or has more than 15 characters.
std::vector<std::byte> simulated_image(std::string_view version);

}  // namespace host
