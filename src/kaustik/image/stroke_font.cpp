#include "kaustik/image/stroke_font.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/to_integer.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

/// Strokes are separated by blanks; each is a chain of points "xy" with the baseline at y = 0 and
/// the top of digits at y = 8.
struct Glyph {
  std::string_view character;
  int width;  ///< the largest x
  std::string_view strokes;
};

constexpr Glyph glyphs[] = {{"0", 4, "103041473818070110"},
                            {"1", 2, "062820"},
                            {"2", 4, "07183847450040"},
                            {"3", 4, "07183847453414 344341301001"},
                            {"4", 4, "30380343"},
                            {"5", 4, "480805354441301001"},
                            {"6", 4, "4738180701103041443505"},
                            {"7", 4, "084810"},
                            {"8", 4, "183847453414050718 1403011030414334"},
                            {"9", 4, "0110304147381807041343"},
                            {".", 0, "00"},
                            {"-", 3, "0434"},
                            {"+", 4, "0444 2226"},
                            {"/", 3, "0038"},
                            {" ", 2, ""},
                            {"c", 3, "3425150401102031"},
                            {"d", 3, "3830 3425150401102031"},
                            {"e", 3, "033334251504011030"},
                            {"k", 3, "0800 3502 1330"},
                            {"l", 0, "0800"},
                            {"m", 6, "0005 0415253430 3445556460"},
                            {"x", 3, "0035 0530"},
                            {"W", 6, "0810365068"},
                            {"²", 2, "070828270525"},
                            {"≤", 4, "480542 0040"},
                            {"≥", 4, "084502 0040"}};
constexpr Glyph unknown = {"", 4, "0040480800"};

/// In heights of a digit.
constexpr float unit = 1.0f / 8, gap = 2.2f * unit, half_thickness = 0.6f * unit;

const Glyph& next_glyph(std::string_view& text) {
  for (const Glyph& glyph : glyphs)
    if (text.starts_with(glyph.character)) {
      text.remove_prefix(glyph.character.size());
      return glyph;
    }
  // One character of UTF-8: what follows its first byte starts with bits 10.
  do text.remove_prefix(1);
  while (!text.empty() && (uint8_t(text[0]) & 0xc0) == 0x80);
  return unknown;
}

float distance_to_segment(const Vec2f& p, const Vec2f& a, const Vec2f& b) {
  const Vec2f ab = b - a;
  const float along = ab.length2() > 0 ? std::clamp((p - a).dot(ab) / ab.length2(), 0.0f, 1.0f) : 0;
  return (p - (a + ab * along)).length();
}

/// From a point in the glyph's coordinates to the nearest line.
float distance_to(const Glyph& glyph, const Vec2f& p) {
  float nearest = infinity;
  const std::string_view strokes = glyph.strokes;
  for (size_t i = 0; i + 1 < strokes.size();) {
    if (strokes[i] == ' ') {
      ++i;
      continue;
    }
    const Vec2f a(float(strokes[i] - '0'), float(strokes[i + 1] - '0'));
    const bool goes_on = i + 3 < strokes.size() && strokes[i + 2] != ' ';
    const Vec2f b = goes_on ? Vec2f(float(strokes[i + 2] - '0'), float(strokes[i + 3] - '0')) : a;
    nearest = std::min(nearest, distance_to_segment(p, a, b));
    i += 2;
  }
  return nearest;
}

void blend(float& value, float color, float coverage) {
  const float encoded =
      srgb_from_linear(value) * (1 - coverage) + srgb_from_linear(color) * coverage;
  value = std::clamp(linear_from_srgb(encoded), 0.0f, 1.0f);
}

void draw_glyph(Image& image, const Glyph& glyph, float x, float y, float height,
                const Vec3f& color) {
  const float scale = height * unit, half_line = std::max(0.5f, half_thickness * height);
  const float margin = half_line + 1;
  const auto within = [](float value, int size) { return to_integer(value, 0, size); };
  const int x0 = within(x - margin, image.width());
  const int x1 = within(x + float(glyph.width) * scale + margin + 1, image.width());
  const int y0 = within(y - height - margin, image.height());
  const int y1 = within(y + margin + 1, image.height());
  const std::array<int, 3> channels = {image.find_channel("R"), image.find_channel("G"),
                                       image.find_channel("B")};
  for (int py = y0; py < y1; ++py)
    for (int px = x0; px < x1; ++px) {
      const Vec2f p((float(px) + 0.5f - x) / scale, (y - float(py) - 0.5f) / scale);
      const float coverage =
          std::clamp(half_line + 0.5f - distance_to(glyph, p) * scale, 0.0f, 1.0f);
      if (coverage == 0) continue;
      for (int c = 0; c < 3; ++c) blend(image.at(px, py, channels[size_t(c)]), color[c], coverage);
    }
}

}  // namespace

float text_width(std::string_view text) {
  float width = 0;
  while (!text.empty()) width += float(next_glyph(text).width) * unit + gap;
  return std::max(0.0f, width - gap);
}

void draw_text(Image& image, std::string_view text, float x, float y, float height,
               const Vec3f& color) {
  while (!text.empty()) {
    const Glyph& glyph = next_glyph(text);
    draw_glyph(image, glyph, x, y, height, color);
    x += (float(glyph.width) * unit + gap) * height;
  }
}

}  // namespace kaustik
