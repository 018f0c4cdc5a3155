// Images for the simulated board, to try updates. Its program is always this one, whatever the image contains.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace host {

/// An image of this version does not run on the simulated board: it hangs, and the watchdog resets the board.
inline constexpr std::string_view kHangingVersion = "hangs";

/// A whole image of 4 KB. Throws Failure(usage) for a version of more than 15 characters, or none.
std::vector<std::byte> simulated_image(std::string_view version);

}  // namespace host
