#pragma once
// For this room's own sources.

#include <cstdint>
#include <vector>

#include "kaustik/display/screen_pixels.h"

namespace kaustik {

/// The picture as a PNG file.
std::vector<uint8_t> png_bytes(const ScreenPixels& pixels);

}  // namespace kaustik
