#pragma once
// A small font of lines, for numbers and units in pictures: digits, the letters of cd/m², lx and W,
// signs and a blank. Other characters show as a box. Texts are UTF-8.

#include <string_view>

#include "kaustik/image/image.h"

namespace kaustik {

/// Width of `text` in units of a digit's height.
float text_width(std::string_view text);

/// Draws `text` in `color` (display-linear) over "R", "G", "B" of `image`: the left end of its
/// baseline at (x, y) in pixels from the top left corner, digits `height` pixels high. What lies
/// outside the image is left out.
void draw_text(Image& image, std::string_view text, float x, float y, float height,
               const Vec3f& color);

}  // namespace kaustik
