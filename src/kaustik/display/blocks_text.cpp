#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <optional>

#include "kaustik/display/terminal_text.h"

namespace kaustik {
namespace {

using Rgb8 = std::array<uint8_t, 3>;

Rgb8 rgb_at(const ScreenPixels& pixels, int x, int y) {
  const uint8_t* rgb = pixels.at(x, y);
  return {rgb[0], rgb[1], rgb[2]};
}

/// Values of xterm's 6 × 6 × 6 colours from number 16 on.
constexpr std::array<int, 6> cube_levels = {0, 95, 135, 175, 215, 255};

int nearest_level(int value) {
  int best = 0;
  for (int i = 1; i < int(cube_levels.size()); ++i)
    if (std::abs(cube_levels[size_t(i)] - value) < std::abs(cube_levels[size_t(best)] - value))
      best = i;
  return best;
}

/// The number of the nearest of xterm's 256 colours: of the cube, or of the 24 greys from 232 on.
int nearest_of_256(const Rgb8& colour) {
  const auto distance = [&](int r, int g, int b) {
    const int dr = r - colour[0], dg = g - colour[1], db = b - colour[2];
    return dr * dr + dg * dg + db * db;
  };
  const int r = nearest_level(colour[0]), g = nearest_level(colour[1]),
            b = nearest_level(colour[2]);
  const int mean = (colour[0] + colour[1] + colour[2]) / 3;
  const int step = std::clamp((mean - 3) / 10, 0, 23), grey = 8 + 10 * step;
  const bool is_grey =
      distance(grey, grey, grey) <
      distance(cube_levels[size_t(r)], cube_levels[size_t(g)], cube_levels[size_t(b)]);
  return is_grey ? 232 + step : 16 + 36 * r + 6 * g + b;
}

/// Select Graphic Rendition of ECMA-48: 38 is the front, 48 the back.
void set_colour(std::string& text, int which, const Rgb8& colour, bool full_colour) {
  if (full_colour)
    fmt::format_to(std::back_inserter(text), "\x1b[{};2;{};{};{}m", which, colour[0], colour[1],
                   colour[2]);
  else
    fmt::format_to(std::back_inserter(text), "\x1b[{};5;{}m", which, nearest_of_256(colour));
}

}  // namespace

std::string blocks_text(const ScreenPixels& pixels, bool full_colour) {
  std::string text;
  for (int y = 0; y < pixels.height; y += 2) {
    if (y > 0) text += "\r\n";
    const bool has_below = y + 1 < pixels.height;
    std::optional<Rgb8> front, back;
    for (int x = 0; x < pixels.width; ++x) {
      const Rgb8 above = rgb_at(pixels, x, y);
      if (front != above) set_colour(text, 38, above, full_colour);
      front = above;
      if (has_below) {
        const Rgb8 below = rgb_at(pixels, x, y + 1);
        if (back != below) set_colour(text, 48, below, full_colour);
        back = below;
      }
      text += "▀";
    }
    text += "\x1b[0m";
  }
  return text;
}

}  // namespace kaustik
