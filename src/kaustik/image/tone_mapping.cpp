#include "kaustik/image/tone_mapping.h"

#include <fmt/format.h>

#include <algorithm>
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

Image tone_map(const Image& image, const ToneOperator& tone, const std::string& layer,
               const std::optional<FieldOfView>& view, bool in_frame) {
  const Picture picture(image, layer, view ? *view : field_of_view(image).value_or(FieldOfView{}));
  const std::vector<Vec3f> colours = tone.displayed(picture);
  const RgbView rgb = rgb_view(image, layer);
  Image result(image.width(), image.height(), {"R", "G", "B"});
  for (size_t i = 0; i < colours.size(); ++i) {
    const Vec3f shown = is_finite(rgb[i]) ? into_gamut(colours[i]) : Vec3f(shown_for_bad(rgb[i]));
    for (int c = 0; c < 3; ++c) result.channel(c)[i] = shown[c];
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
