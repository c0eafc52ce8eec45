#include "kaustik/image/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

void check_same_size(const Image& image, const Image& reference) {
  if (image.width() != reference.width() || image.height() != reference.height())
    throw Error(ErrorKind::input,
                fmt::format("the images differ in size: {} x {} and {} x {}", image.width(),
                            image.height(), reference.width(), reference.height()),
                "compare images of the same size");
}

/// Mean over the channels of (x − r)²/(r² + 0.01).
double mean_relative_error_sq(const Vec3d& x, const Vec3d& r) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += sqr(x[c] - r[c]) / (sqr(r[c]) + 0.01);
  return sum / 3;
}

double mean_of(const std::vector<double>& values, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += values[i];
  return count > 0 ? sum / double(count) : 0;
}

double ratio(double a, double b) { return a == b ? 1 : a / b; }

std::string text_of(const Image& image) {
  const PictureFrame& f = image.frame();
  const std::string size = fmt::format("{} x {} pixels", image.width(), image.height());
  if (image.is_whole()) return size;
  return fmt::format("{} at ({}, {}) of {} x {}", size, f.x, f.y, f.width, f.height);
}

bool have_same_size(const Image& a, const Image& b) {
  return a.width() == b.width() && a.height() == b.height();
}

/// Whether `part` lies in `whole`, both being windows of pictures of one size.
bool is_inside(const Image& part, const Image& whole) {
  const PictureFrame &p = part.frame(), &w = whole.frame();
  return p.width == w.width && p.height == w.height && p.x >= w.x && p.y >= w.y &&
         int64_t(p.x) + part.width() <= int64_t(w.x) + whole.width() &&
         int64_t(p.y) + part.height() <= int64_t(w.y) + whole.height();
}

Image part_of(const Image& whole, const Image& part) {
  return window_of(whole, part.frame().x, part.frame().y, part.width(), part.height());
}

}  // namespace

SamePixels same_pixels(Image image, Image reference) {
  const bool is_same_window = image.frame() == reference.frame();
  const bool has_one_frame = image.is_whole() || reference.is_whole();
  if (have_same_size(image, reference) && (is_same_window || has_one_frame))
    return {std::move(image), std::move(reference)};
  // What an EXR has beyond its display window is no part of the picture.
  image = visible_part(std::move(image));
  reference = visible_part(std::move(reference));
  if (is_inside(image, reference)) {
    Image part = part_of(reference, image);
    return {std::move(image), std::move(part)};
  }
  if (is_inside(reference, image)) {
    Image part = part_of(image, reference);
    return {std::move(part), std::move(reference)};
  }
  throw Error(ErrorKind::input,
              fmt::format("the images show different pixels: {}, and {}", text_of(image),
                          text_of(reference)),
              "compare images of the same size, or a crop window with the whole picture");
}

double trimmed_mean(std::vector<double> values) {
  const size_t dropped = values.size() / 1000;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(dropped), values.end(),
                   std::greater<>());
  values.erase(values.begin(), values.begin() + std::ptrdiff_t(dropped));
  return mean_of(values, values.size());
}

ImageComparison compare_images(const Image& image, const Image& reference,
                               const std::string& layer) {
  check_same_size(image, reference);
  const RgbView x = rgb_view(image, layer);
  const RgbView r = rgb_view(reference, layer);
  ImageComparison result;
  Vec3d sum(0), reference_sum(0);
  double squares = 0;
  std::vector<double> pixel_errors;
  pixel_errors.reserve(image.pixel_count());
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const Vec3d a(x[i]), b(r[i]);
    if (!is_finite(x[i]) || !is_finite(r[i])) {
      ++result.non_finite_pixels;
      continue;
    }
    sum += a;
    reference_sum += b;
    squares += (a - b).length2();
    pixel_errors.push_back(mean_relative_error_sq(a, b));
  }
  result.pixel_count = pixel_errors.size();
  if (result.pixel_count == 0)
    throw Error(ErrorKind::input, "no pixel is finite in both images", "check how they were made");
  const double count = double(result.pixel_count);
  result.mse = squares / (3 * count);
  result.mean = sum / count;
  result.reference_mean = reference_sum / count;
  for (int c = 0; c < 3; ++c)
    result.mean_ratio[c] = ratio(result.mean[c], result.reference_mean[c]);
  result.relative_mse = mean_of(pixel_errors, pixel_errors.size());
  result.relative_mse_trimmed = trimmed_mean(std::move(pixel_errors));
  return result;
}

double own_relative_mse(const Image& reference) {
  const RgbView r = rgb_view(reference), error = rgb_view(reference, "error");
  std::vector<double> pixel_errors;
  pixel_errors.reserve(reference.pixel_count());
  for (size_t i = 0; i < reference.pixel_count(); ++i)
    if (is_finite(r[i]) && is_finite(error[i]))
      pixel_errors.push_back(mean_relative_error_sq(Vec3d(r[i]) + Vec3d(error[i]), Vec3d(r[i])));
  return trimmed_mean(std::move(pixel_errors));
}

Image difference_image(const Image& image, const Image& reference, float full_scale,
                       const std::string& layer) {
  check_same_size(image, reference);
  if (!(full_scale > 0))
    throw Error(ErrorKind::input, fmt::format("a full scale of {}", full_scale),
                "the full scale of a difference picture must be above 0");
  const RgbView x = rgb_view(image, layer);
  const RgbView r = rgb_view(reference, layer);
  Image picture(image.width(), image.height(), {"R", "G", "B"});
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const float value = photopic(x[i]), wanted = photopic(r[i]);
    const float relative = (value - wanted) / ((std::fabs(wanted) + 0.1f) * full_scale);
    const float amount = std::min(1.0f, std::fabs(relative));
    Vec3f colour =
        relative > 0 ? Vec3f(1, 1 - amount, 1 - amount) : Vec3f(1 - amount, 1 - amount, 1);
    if (!is_finite(x[i]) || !is_finite(r[i])) colour = Vec3f(0, 1, 0);
    for (int c = 0; c < 3; ++c) picture.channel(c)[i] = colour[c];
  }
  return picture;
}

}  // namespace kaustik
