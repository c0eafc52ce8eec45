#pragma once
// Pictures as text for terminals. Each begins at the cursor, in the first column, with its upper
// left corner, and stays within its rows.

#include <cstdint>
#include <string>

#include "kaustik/display/screen_pixels.h"
#include "kaustik/display/terminal.h"

namespace kaustik {

/// Two pixels in each character, by its colours of front and back. Rows end with CR LF, but the
/// last; of an odd number of rows of pixels the last has nothing below. Leaves the terminal's
/// own colours.
std::string blocks_text(const ScreenPixels& pixels, bool full_colour);

/// 6 × 7 × 6 colours, with ordered dithering.
std::string sixel_text(const ScreenPixels& pixels);

/// Stored as image `id` and shown in so many characters, without moving the cursor and without an
/// answer. An image with the number `replaced`, if that is not 0, is deleted afterwards.
std::string kitty_text(const ScreenPixels& pixels, const PicturePlace& place, uint32_t id,
                       uint32_t replaced);

std::string iterm_text(const ScreenPixels& pixels, const PicturePlace& place);

}  // namespace kaustik
