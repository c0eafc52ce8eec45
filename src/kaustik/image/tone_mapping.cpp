#include "kaustik/image/tone_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

void check(const ToneMapping& mapping) {
  const auto require = [](bool holds, const char* name, float value, const char* range) {
    if (!holds)
      throw Error(ErrorKind::input, fmt::format("tone mapping: {} is {}", name, value),
                  fmt::format("it must be {}", range));
  };
  const float h = mapping.horizontal_fov, v = mapping.vertical_fov;
  require(std::isfinite(mapping.exposure), "exposure", mapping.exposure, "finite");
  require(h > 0 && h < 180, "horizontal field of view", h, "between 0 and 180 degrees");
  require(v >= 0 && v < 180, "vertical field of view", v,
          "0 (from the aspect) or below 180 degrees");
  const float white = mapping.display_max_luminance, range = mapping.display_dynamic_range;
  require(white > 0 && std::isfinite(white), "display maximum", white, "above 0 cd/m²");
  require(range > 1 && std::isfinite(range), "display dynamic range", range, "above 1");
}

float half_tangent(float degrees) { return std::tan(degrees * pi / 360); }

/// Number of 1° cells along an image side.
int cells_across(float half_extent, int pixels) {
  return int(std::clamp(std::round(half_extent / half_tangent(1)), 1.0f, float(pixels)));
}

/// Weights 1 4 6 4 1 with the ends mirrored: keeps the sum, and no bin next to a full one is empty.
std::vector<double> smoothed(const std::vector<double>& bins) {
  static constexpr double weights[] = {1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16.};
  const int count = int(bins.size());
  std::vector<double> result(bins.size(), 0.0);
  for (int i = 0; i < count; ++i)
    for (int offset = -2; offset <= 2; ++offset) {
      int j = i + offset;
      if (j < 0) j = -1 - j;
      if (j >= count) j = 2 * count - 1 - j;
      result[size_t(j)] += weights[offset + 2] * bins[size_t(i)];
    }
  return result;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

/// Cuts what stands above the ceiling where display contrast would exceed that of the scene
/// (histogram adjustment with a linear ceiling, section 4.4 of the paper), until next to nothing is
/// left to cut. The paper gives up and scales linearly when all has been cut away; bins that are
/// never empty make sure that it cannot happen here.
void trim_to_linear_ceiling(std::vector<double>& bins, double bin_width, double display_range) {
  constexpr double tolerance = 1e-3;
  constexpr int most_rounds = 10000;
  for (int round = 0; round < most_rounds; ++round) {
    const double total = sum_of(bins);
    const double ceiling = total * bin_width / display_range;
    for (double& bin : bins) bin = std::min(bin, ceiling);
    if (total - sum_of(bins) <= tolerance * total) return;
  }
}

Vec3f displayed(const Vec3f& rgb, float scale) {
  if (std::isnan(rgb.x + rgb.y + rgb.z)) {
    // Either a NaN, which shows as black, or infinities of both signs.
    return Vec3f(0);
  }
  if (std::max({rgb.x, rgb.y, rgb.z}) == infinity) return Vec3f(1);
  if (!is_finite(rgb)) return Vec3f(0);
  return into_gamut(rgb * scale);
}

}  // namespace

ToneOperator tone_operator_from_name(const std::string& name) {
  if (name == "srgb") return ToneOperator::srgb;
  if (name == "linear") return ToneOperator::linear;
  if (name == "histogram") return ToneOperator::histogram;
  throw Error(ErrorKind::input, fmt::format("unknown tone mapping '{}'", name),
              suggest(name, {"histogram", "linear", "srgb"}));
}

std::vector<float> foveal_luminances(const RgbView& rgb, int width, int height,
                                     const ToneMapping& mapping) {
  const float half_width = half_tangent(mapping.horizontal_fov);
  const float half_height = mapping.vertical_fov > 0 ? half_tangent(mapping.vertical_fov)
                                                     : half_width * float(height) / float(width);
  const int columns = cells_across(half_width, width), rows = cells_across(half_height, height);
  std::vector<double> sums(size_t(columns) * size_t(rows), 0.0);
  std::vector<int64_t> counts(sums.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec3f colour = rgb[size_t(y) * size_t(width) + size_t(x)];
      if (!is_finite(colour)) continue;
      const int64_t row = int64_t(y) * rows / height, column = int64_t(x) * columns / width;
      const size_t cell = size_t(row * columns + column);
      sums[cell] += double(luminance(colour));
      ++counts[cell];
    }
  std::vector<float> means;
  for (size_t i = 0; i < sums.size(); ++i)
    if (counts[i] > 0) means.push_back(float(sums[i] / double(counts[i])));
  return means;
}

HistogramAdjustment::HistogramAdjustment(const std::vector<float>& luminances,
                                         const ToneMapping& mapping)
    : display_black_(mapping.display_max_luminance / mapping.display_dynamic_range),
      display_white_(mapping.display_max_luminance) {
  check(mapping);
  std::vector<double> logs;
  for (const float value : luminances)
    if (value > 0 && std::isfinite(value)) logs.push_back(std::log(double(value)));
  if (logs.empty()) return;
  log_max_ = *std::max_element(logs.begin(), logs.end());
  // Eight decades show all that can be told apart; near-zeros must not stretch the scale.
  log_min_ = std::max(*std::min_element(logs.begin(), logs.end()), log_max_ - 8 * std::log(10.0));
  const double display_range = std::log(double(mapping.display_dynamic_range));
  is_linear_ = log_max_ - log_min_ <= display_range;
  if (!is_linear_) adjust(logs, display_range);
}

void HistogramAdjustment::adjust(const std::vector<double>& logs, double display_range) {
  const double bin_width = (log_max_ - log_min_) / bin_count;
  std::vector<double> bins(bin_count, 0.0);
  for (const double value : logs) {
    // Shared between the two nearest bins, so that a small change of a sample is one of the curve.
    const double x = std::clamp((value - log_min_) / bin_width - 0.5, 0.0, bin_count - 1.0);
    const int lower = std::min(int(x), bin_count - 2);
    bins[size_t(lower)] += lower + 1 - x;
    bins[size_t(lower) + 1] += x - lower;
  }
  bins = smoothed(bins);
  // No bin is empty: the curve rises everywhere, and luminances of few samples keep some contrast.
  constexpr double least_share = 0.01;
  for (double& bin : bins) bin += least_share * double(logs.size()) / bin_count;
  trim_to_linear_ceiling(bins, bin_width, display_range);
  const double total = sum_of(bins);
  double below = 0;
  for (size_t i = 0; i < bins.size(); ++i) {
    below += bins[i];
    cumulative_[i + 1] = below / total;
  }
}

float HistogramAdjustment::display_luminance(float world_luminance) const {
  if (!(world_luminance > 0)) return display_black_;
  const double log_world = std::log(double(world_luminance));
  if (is_linear_) {
    // The brightest cell becomes white, which the adjusted curve tends to as the range shrinks.
    const double scaled = double(display_white_) * std::exp(log_world - log_max_);
    return float(std::clamp(scaled, double(display_black_), double(display_white_)));
  }
  const double x = std::clamp((log_world - log_min_) / (log_max_ - log_min_), 0.0, 1.0) * bin_count;
  const size_t bin = std::min(size_t(x), size_t(bin_count) - 1);
  const double share =
      cumulative_[bin] + (x - double(bin)) * (cumulative_[bin + 1] - cumulative_[bin]);
  const double log_black = std::log(double(display_black_));
  const double log_white = std::log(double(display_white_));
  return std::clamp(float(std::exp(log_black + (log_white - log_black) * share)), display_black_,
                    display_white_);
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

Image tone_map(const Image& image, const ToneMapping& mapping, const std::string& layer) {
  check(mapping);
  const RgbView rgb = rgb_view(image, layer);
  Image result(image.width(), image.height(), {"R", "G", "B"});
  const auto fill = [&](const auto& scale_of) {
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      const Vec3f colour = displayed(rgb[i], scale_of(rgb[i]));
      for (int c = 0; c < 3; ++c) result.channel(c)[i] = colour[c];
    }
  };
  if (mapping.op != ToneOperator::histogram) {
    const float scale = mapping.op == ToneOperator::linear ? std::exp2(mapping.exposure) : 1.0f;
    fill([&](const Vec3f&) { return scale; });
    return result;
  }
  const HistogramAdjustment curve(foveal_luminances(rgb, image.width(), image.height(), mapping),
                                  mapping);
  const float black = curve.display_black(), range = curve.display_white() - black;
  fill([&](const Vec3f& colour) {
    const float y = photopic(colour);
    if (!(y > 0) || !std::isfinite(y)) return 0.0f;
    return (curve.display_luminance(white_efficacy * y) - black) / (range * y);
  });
  return result;
}

std::vector<uint8_t> srgb_bytes(const Image& display_linear) {
  const RgbView rgb = rgb_view(display_linear);
  std::vector<uint8_t> bytes;
  bytes.reserve(3 * display_linear.pixel_count());
  for (size_t i = 0; i < display_linear.pixel_count(); ++i)
    for (const auto& plane : rgb.planes) {
      const float encoded = srgb_from_linear(std::clamp(plane[i], 0.0f, 1.0f));
      bytes.push_back(uint8_t(std::isnan(encoded) ? 0.0f : encoded * 255 + 0.5f));
    }
  return bytes;
}

}  // namespace kaustik
