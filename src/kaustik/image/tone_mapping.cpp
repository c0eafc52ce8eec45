#include "kaustik/image/tone_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/tone_operators.h"

namespace kaustik {
namespace {

/// What a pixel that is not finite shows as.
float shown_for_bad(const Vec3f& rgb) {
  // Infinities of both signs have a NaN for their sum.
  if (std::isnan(rgb.x + rgb.y + rgb.z)) return 0;
  return std::max({rgb.x, rgb.y, rgb.z}) == infinity ? 1 : 0;
}

std::vector<Property> properties(const std::vector<std::string>& settings) {
  std::vector<Property> result;
  for (const std::string& setting : settings) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorKind::input, fmt::format("cannot read the setting '{}'", setting),
                  "write name=value");
    result.push_back({setting.substr(0, equals), Untyped{setting.substr(equals + 1)}, {}});
  }
  return result;
}

}  // namespace

const std::vector<ToneOperatorType>& tone_operator_types() {
  static const std::vector<ToneOperatorType> types{histogram_tone(), reinhard_tone(),
                                                   aces_tone(),      linear_tone(),
                                                   srgb_tone(),      falsecolor_tone()};
  return types;
}

std::vector<std::string> tone_operator_names() {
  std::vector<std::string> names;
  for (const ToneOperatorType& type : tone_operator_types()) names.push_back(type.info.name);
  return names;
}

std::shared_ptr<const ToneOperator> make_tone_operator(const std::string& name,
                                                       const std::vector<std::string>& settings) {
  for (const ToneOperatorType& type : tone_operator_types()) {
    if (type.info.name != name) continue;
    Problems problems;
    const Arguments arguments(type.info, properties(settings), {}, problems);
    problems.throw_if_any();
    return type.make(arguments);
  }
  throw Error(ErrorKind::input, fmt::format("unknown tone mapping '{}'", name),
              suggest(name, tone_operator_names()));
}

Vec3f into_gamut(const Vec3f& rgb) {
  const float y = photopic(rgb);
  if (!(y > 0)) return Vec3f(0);
  if (y >= 1) return Vec3f(1);
  float kept = 1;
  for (int c = 0; c < 3; ++c) {
    if (rgb[c] > 1) kept = std::min(kept, (1 - y) / (rgb[c] - y));
    if (rgb[c] < 0) kept = std::min(kept, y / (y - rgb[c]));
  }
  if (kept == 1) return rgb;
  Vec3f result;
  for (int c = 0; c < 3; ++c) result[c] = std::clamp(y + kept * (rgb[c] - y), 0.0f, 1.0f);
  return result;
}

/// Pixels that a lamp fills in part.
struct LampEdges {
  std::vector<size_t> pixels;
  std::vector<float> shares;  ///< of the lamp, in (0, 1)
};

/// Puts the colours of lamp and rest of such pixels into the picture's parts, two for each pixel.
LampEdges split_lamp_edges(const Image& image, const RgbView& rgb, Picture& picture) {
  LampEdges edges;
  const int share_channel = image.find_channel("emission.A");
  const std::array<int, 3> channels = {image.find_channel("emission.R"),
                                       image.find_channel("emission.G"),
                                       image.find_channel("emission.B")};
  if (share_channel < 0 || *std::min_element(channels.begin(), channels.end()) < 0) return edges;
  for (size_t i = 0; i < picture.pixel_count(); ++i) {
    const float share = image.channel(share_channel)[i];
    if (!(share > 0 && share < 1)) continue;
    Vec3f lamp, rest;
    for (int c = 0; c < 3; ++c) {
      const float light = image.channel(channels[size_t(c)])[i];
      lamp[c] = light / share;
      rest[c] = std::max(0.0f, rgb[i][c] - light) / (1 - share);
    }
    if (!is_finite(lamp) || !is_finite(rest)) continue;
    edges.pixels.push_back(i);
    edges.shares.push_back(share);
    picture.parts.insert(picture.parts.end(), {lamp, rest});
  }
  return edges;
}

Image tone_map(const Image& image, const ToneOperator& tone, const std::string& layer,
               const std::optional<FieldOfView>& view, bool in_frame) {
  Picture picture(image, layer, view ? *view : field_of_view(image).value_or(FieldOfView{}));
  const RgbView rgb = rgb_view(image, layer);
  const LampEdges edges =
      layer.empty() && tone.shows_parts() ? split_lamp_edges(image, rgb, picture) : LampEdges{};
  const std::vector<Vec3f> colours = tone.displayed(picture);
  Image result(image.width(), image.height(), {"R", "G", "B"});
  const size_t pixel_count = picture.pixel_count();
  for (size_t i = 0; i < pixel_count; ++i) {
    const Vec3f shown = is_finite(rgb[i]) ? into_gamut(colours[i]) : Vec3f(shown_for_bad(rgb[i]));
    for (int c = 0; c < 3; ++c) result.channel(c)[i] = shown[c];
  }
  for (size_t k = 0; k < edges.pixels.size(); ++k) {
    const Vec3f lamp = into_gamut(colours[pixel_count + 2 * k]),
                rest = into_gamut(colours[pixel_count + 2 * k + 1]);
    for (int c = 0; c < 3; ++c)
      result.channel(c)[edges.pixels[k]] = std::lerp(rest[c], lamp[c], edges.shares[k]);
  }
  if (in_frame) {
    result.set_frame(image.frame());
    // A third is for its file.
    result = whole_picture(std::move(result), default_picture_memory() / 3 * 2);
  }
  result = tone.decorated(std::move(result), picture);
  for (const auto& [key, value] : image.metadata()) result.set_metadata(key, value);
  return result;
}

std::vector<uint8_t> srgb_bytes(const Image& display_linear) {
  const RgbView rgb = rgb_view(display_linear);
  std::vector<uint8_t> bytes;
  bytes.reserve(3 * display_linear.pixel_count());
  for (size_t i = 0; i < display_linear.pixel_count(); ++i)
    for (const auto& plane : rgb.planes) {
      const float encoded = srgb_from_linear(std::clamp(plane[i], 0.0f, 1.0f));
      bytes.push_back(to_integer<uint8_t>(encoded * 255 + 0.5f, 0, 255));
    }
  return bytes;
}

}  // namespace kaustik
