#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "kaustik/display/terminal_text.h"

namespace kaustik {
namespace {

constexpr std::array<int, 3> palette_levels = {6, 7, 6};  // eyes see most of green
constexpr int palette_size = 6 * 7 * 6;
constexpr int band_height = 6;

/// Thresholds of Bayer's ordered dithering, 4 × 4, in sixteenths.
constexpr int bayer[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

int palette_index(const uint8_t* rgb, int x, int y) {
  const double threshold = (bayer[y & 3][x & 3] + 0.5) / 16;
  int index = 0;
  for (size_t c = 0; c < 3; ++c) {
    const int levels = palette_levels[c];
    const int level = int(rgb[c] / 255.0 * (levels - 1) + threshold);
    index = index * levels + std::min(level, levels - 1);
  }
  return index;
}

/// Registers hold percentages.
void define_palette(std::string& text) {
  for (int index = 0; index < palette_size; ++index) {
    const int b = index % palette_levels[2], g = index / palette_levels[2] % palette_levels[1],
              r = index / palette_levels[2] / palette_levels[1];
    const auto percent = [](int level, int levels) { return (200 * level / (levels - 1) + 1) / 2; };
    fmt::format_to(std::back_inserter(text), "#{};2;{};{};{}", index, percent(r, palette_levels[0]),
                   percent(g, palette_levels[1]), percent(b, palette_levels[2]));
  }
}

void repeat_sixel(std::string& text, char sixel, size_t count) {
  if (count > 3)
    fmt::format_to(std::back_inserter(text), "!{}{}", count, sixel);
  else
    text.append(count, sixel);
}

/// Which pixels of six rows have one colour, column by column.
void add_sixels(std::string& text, const std::string& sixels) {
  // Columns at the end without a pixel go without saying.
  const size_t end = sixels.find_last_not_of('?') + 1;
  for (size_t i = 0; i < end;) {
    size_t next = i;
    while (next < end && sixels[next] == sixels[i]) ++next;
    repeat_sixel(text, sixels[i], next - i);
    i = next;
  }
}

void add_band(std::string& text, const ScreenPixels& pixels, int top) {
  std::array<std::string, palette_size> of_colour;
  for (int y = top; y < std::min(top + band_height, pixels.height); ++y)
    for (int x = 0; x < pixels.width; ++x) {
      std::string& sixels = of_colour[size_t(palette_index(pixels.at(x, y), x, y))];
      if (sixels.empty()) sixels.assign(size_t(pixels.width), '?');
      sixels[size_t(x)] = char(sixels[size_t(x)] + (1 << (y - top)));
    }
  bool is_first = true;
  for (int index = 0; index < palette_size; ++index) {
    const std::string& sixels = of_colour[size_t(index)];
    if (sixels.empty()) continue;
    if (!is_first) text += '$';
    is_first = false;
    fmt::format_to(std::back_inserter(text), "#{}", index);
    add_sixels(text, sixels);
  }
}

}  // namespace

std::string sixel_text(const ScreenPixels& pixels) {
  std::string text = fmt::format("\x1bP0;1;0q\"1;1;{};{}", pixels.width, pixels.height);
  define_palette(text);
  for (int top = 0; top < pixels.height; top += band_height) {
    if (top > 0) text += '-';
    add_band(text, pixels, top);
  }
  return text + "\x1b\\";
}

}  // namespace kaustik
