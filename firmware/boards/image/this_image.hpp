// The header of the running image, and whether the image in flash is intact.
#pragma once

#include "firmware/app/image_header.hpp"

namespace firmware::boards {

const ImageHeader& this_image();

/// Reads the whole image: about 16 ms at 168 MHz.
ImageState verify_this_image();

}  // namespace firmware::boards
