#include "kaustik/image/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "kaustik/base/error.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

float half_tangent(float degrees) { return std::tan(degrees * pi / 360); }

void check(const FieldOfView& view) {
  const auto require = [](bool holds, const char* name, float value, const char* range) {
    if (!holds)
      throw Error(ErrorKind::input, fmt::format("the {} field of view is {}", name, value),
                  fmt::format("it must be {}", range));
  };
  const float h = view.horizontal, v = view.vertical;
  require(h > 0 && h < 180, "horizontal", h, "between 0 and 180 degrees");
  require(v >= 0 && v < 180, "vertical", v, "0 (from the aspect) or below 180 degrees");
}

/// Number of 1° cells along an image side.
int cells_across(float half_extent, int pixels) {
  return to_integer(std::round(half_extent / half_tangent(1)), 1, pixels);
}

/// Of metadata that are a finite number or its text.
std::optional<float> number_of(const Image& image, const char* key) {
  const MetadataValue* value = image.find_metadata(key);
  if (!value) return std::nullopt;
  double number = 0;
  if (const auto* given = std::get_if<double>(value)) {
    number = *given;
  } else if (const auto* integer = std::get_if<int64_t>(value)) {
    number = double(*integer);
  } else {
    const std::string& text = std::get<std::string>(*value);
    std::from_chars(text.data(), text.data() + text.size(), number);
  }
  if (!std::isfinite(number)) return std::nullopt;
  return float(number);
}

std::optional<float> angle_of(const Image& image, const char* key) {
  const std::optional<float> degrees = number_of(image, key);
  return degrees && *degrees > 0 && *degrees < 180 ? degrees : std::nullopt;
}

}  // namespace

std::optional<FieldOfView> field_of_view(const Image& image) {
  const std::optional<float> horizontal = angle_of(image, "horizontal_fov");
  if (!horizontal) return std::nullopt;
  return FieldOfView{*horizontal, angle_of(image, "vertical_fov").value_or(0.0f)};
}

BadPixels count_bad_pixels(const RgbView& rgb) {
  BadPixels bad;
  for (size_t i = 0; i < rgb.planes[0].size(); ++i) {
    const Vec3f colour = rgb[i];
    if (std::isnan(colour.x + colour.y + colour.z))
      ++bad.not_a_number;
    else if (!is_finite(colour))
      ++bad.infinite;
    else if (photopic(colour) < 0)
      ++bad.negative;
  }
  return bad;
}

Picture::Picture(const Image& image, const std::string& layer, const FieldOfView& view)
    : width(image.width()), height(image.height()) {
  check(view);
  if (const MetadataValue* quantity = image.find_metadata("quantity"))
    is_irradiance = *quantity == MetadataValue("irradiance");
  exposure =
      std::exp2(std::clamp(number_of(image, film_exposure_key).value_or(0.0f), -100.0f, 100.0f));
  const RgbView rgb = rgb_view(image, layer);
  half_width = half_tangent(view.horizontal);
  half_height =
      view.vertical > 0 ? half_tangent(view.vertical) : half_width * float(height) / float(width);
  pixels.reserve(image.pixel_count());
  Vec3f last_good(0);
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const Vec3f colour = rgb[i];
    if (is_finite(colour)) last_good = colour;
    pixels.push_back(last_good);
  }
}

Grid<Vec3f> foveal_means(const Picture& picture) {
  Grid<Vec3f> means;
  means.columns = cells_across(picture.half_width, picture.width);
  means.rows = cells_across(picture.half_height, picture.height);
  const size_t count = size_t(means.columns) * size_t(means.rows);
  std::vector<Vec3d> sums(count, Vec3d(0));
  std::vector<int64_t> counts(count, 0);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const int64_t row = int64_t(y) * means.rows / picture.height;
      const int64_t column = int64_t(x) * means.columns / picture.width;
      const size_t cell = size_t(row * means.columns + column);
      sums[cell] += Vec3d(picture.pixels[size_t(y) * size_t(picture.width) + size_t(x)]);
      ++counts[cell];
    }
  means.cells.reserve(count);
  for (size_t i = 0; i < count; ++i) means.cells.push_back(Vec3f(sums[i] / double(counts[i])));
  return means;
}

}  // namespace kaustik
