#include "kaustik/image/denoise.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/parallel.h"
#include "kaustik/base/vectorize.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

using Plane = std::vector<float>;

/// Averages over 5 × 5 pixels, each twice as sparse as the one before: 62 pixels to either side.
constexpr int rounds = 5;
/// Of the B₃ spline.
constexpr float kernel[5] = {1.0f / 16, 1.0f / 4, 3.0f / 8, 1.0f / 4, 1.0f / 16};
/// The noise is a mean over 5 × 5 pixels: that of single pixels is hardly known from few samples.
constexpr int noise_reach = 2;

// Pixels are unlike by the sum of four terms, each 1 where the weight falls to 1/e:
/// the brightness differs by so many standard deviations of the noise,
constexpr float brightness_tolerance = 4;
/// the squared difference of the unit normals,
constexpr float normal_tolerance_sq = 0.05f;
/// the photopic albedo,
constexpr float albedo_tolerance = 0.15f;
/// the distance from the plane, in steps of the depth from pixel to pixel.
constexpr float plane_tolerance = 1.5f;

/// What noise is at most, that its square be finite.
constexpr float greatest_noise = 1e15f;

/// What light is divided by where a surface hardly reflects.
constexpr float least_albedo = 0.02f;

/// Near e^−x for x ≥ 0 and zero from 8 on; compilers make vectors of it.
inline float falloff(float x) {
  float y = std::max(0.0f, 1.0f - 0.125f * x);
  y *= y;
  y *= y;
  return y * y;
}

/// What is known of the surfaces that the pixels show, without noise.
struct Surfaces {
  int width, height;
  std::array<Plane, 3> normal, albedo;
  Plane lightness;  ///< photopic value of the albedo
  Plane depth;
  Plane inverse_step;  ///< 1 over plane_tolerance steps of the depth from pixel to pixel
};

/// The same from some pixel on.
struct SurfaceRow {
  SurfaceRow(const Surfaces& s, std::ptrdiff_t first)
      : normal{s.normal[0].data() + first, s.normal[1].data() + first, s.normal[2].data() + first},
        lightness(s.lightness.data() + first),
        depth(s.depth.data() + first) {}
  const float* normal[3];
  const float* lightness;
  const float* depth;
};

/// Calls body(i) for every pixel, in parallel.
template <typename Body>
void for_pixels(size_t count, const Body& body) {
  parallel_blocks(count, 1 << 14, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) body(i);
  });
}

/// A part of the light.
struct Signal {
  std::array<Plane, 3> rgb;
  Plane variance;  ///< of the photopic value's noise; empty: not known
};

Plane brightness_of(const Signal& s) {
  Plane result(s.rgb[0].size());
  for_pixels(result.size(), [&](size_t i) {
    result[i] = photopic({s.rgb[0][i], s.rgb[1][i], s.rgb[2][i]});
  });
  return result;
}

/// How unlike the surfaces of pixels x of both rows are.
inline float unlikeness(const SurfaceRow& p, const SurfaceRow& q, const float* inverse_step,
                        float inverse_distance, int x) {
  float normals = 0;
  for (int k = 0; k < 3; ++k) {
    const float difference = p.normal[k][x] - q.normal[k][x];
    normals += difference * difference;
  }
  return normals * (1 / normal_tolerance_sq) +
         std::fabs(p.lightness[x] - q.lightness[x]) * (1 / albedo_tolerance) +
         std::fabs(p.depth[x] - q.depth[x]) * inverse_step[x] * inverse_distance;
}

/// A neighbour that every pixel of a row has, but for those too near to the edge.
struct Neighbor {
  int dx, dy;              ///< in the pattern, not yet multiplied by its step
  int begin, end;          ///< the pixels x that have it
  std::ptrdiff_t row;      ///< index of the neighbour of x = 0, were there one
  float inverse_distance;  ///< 1 over its distance in pixels (of the pixel itself: 1)
};

/// Calls visit(neighbor) for those within `reach` steps of `step` pixels.
template <typename Visit>
void for_neighbors(const Surfaces& s, size_t y, int reach, int step, const Visit& visit) {
  for (int dy = -reach; dy <= reach; ++dy) {
    const int other = int(y) + dy * step;
    if (other < 0 || other >= s.height) continue;
    for (int dx = -reach; dx <= reach; ++dx) {
      const int shift = dx * step;
      const float distance = float(step) * std::sqrt(float(dx * dx + dy * dy));
      visit(Neighbor{dx, dy, std::max(0, -shift), std::min(s.width, s.width - shift),
                     std::ptrdiff_t(other) * s.width + shift, 1 / std::max(1.0f, distance)});
    }
  }
}

/// Mean of a plane over like surfaces nearby.
Plane mean_of_like(const Surfaces& s, const Plane& values) {
  Plane result(values.size());
  const auto width = size_t(s.width);
  parallel_blocks(size_t(s.height), 4, [&](size_t first, size_t last, size_t) {
    Plane weight_row(width), sum_row(width);
    for (size_t y = first; y < last; ++y) {
      std::fill(weight_row.begin(), weight_row.end(), 0.0f);
      std::fill(sum_row.begin(), sum_row.end(), 0.0f);
      float *weights = weight_row.data(), *sums = sum_row.data();
      const SurfaceRow p(s, std::ptrdiff_t(y * width));
      const float* inverse_step = s.inverse_step.data() + y * width;
      for_neighbors(s, y, noise_reach, 1, [&](const Neighbor& n) {
        const SurfaceRow q(s, n.row);
        const float* from = values.data() + n.row;
        KAUSTIK_INDEPENDENT_TURNS
        for (int x = n.begin; x < n.end; ++x) {
          const float w = falloff(unlikeness(p, q, inverse_step, n.inverse_distance, x));
          weights[x] += w;
          sums[x] += w * from[x];
        }
      });
      for (size_t x = 0; x < width; ++x)
        if (weights[x] > 0) result[y * width + x] = sums[x] / weights[x];
    }
  });
  return result;
}

/// Where samples do not tell the noise: the variance of the brightness around each pixel, which
/// takes what detail there is for noise.
Plane variance_around(const Surfaces& s, const Plane& brightness) {
  Plane result = brightness;
  for (float& value : result) value *= value;
  result = mean_of_like(s, result);
  const Plane means = mean_of_like(s, brightness);
  for (size_t i = 0; i < result.size(); ++i)
    result[i] = std::max(0.0f, result[i] - means[i] * means[i]);
  return result;
}

/// Averages of like pixels that are `step` apart.
Signal averaged(const Surfaces& s, const Signal& signal, int step) {
  const Plane brightness = brightness_of(signal);
  Signal result = signal;
  const auto width = size_t(s.width);
  parallel_blocks(size_t(s.height), 4, [&](size_t first, size_t last, size_t) {
    Plane rows[6];
    for (Plane& row : rows) row.resize(width);
    float *weights = rows[0].data(), *variances = rows[1].data(), *red = rows[2].data();
    float *green = rows[3].data(), *blue = rows[4].data(), *inverse_noise = rows[5].data();
    for (size_t y = first; y < last; ++y) {
      const size_t row = y * width;
      for (int k = 0; k < 5; ++k) std::fill(rows[k].begin(), rows[k].end(), 0.0f);
      for (size_t x = 0; x < width; ++x)
        inverse_noise[x] =
            1 / (brightness_tolerance * std::sqrt(signal.variance[row + x]) + 1e-12f);
      const SurfaceRow p(s, std::ptrdiff_t(row));
      const float* inverse_step = s.inverse_step.data() + row;
      const float* here = brightness.data() + row;
      for_neighbors(s, y, 2, step, [&](const Neighbor& n) {
        const SurfaceRow q(s, n.row);
        const float *there = brightness.data() + n.row, *noise = signal.variance.data() + n.row;
        const float *r = signal.rgb[0].data() + n.row, *g = signal.rgb[1].data() + n.row;
        const float* b = signal.rgb[2].data() + n.row;
        const float share = kernel[n.dx + 2] * kernel[n.dy + 2];
        KAUSTIK_INDEPENDENT_TURNS
        for (int x = n.begin; x < n.end; ++x) {
          const float w = share * falloff(unlikeness(p, q, inverse_step, n.inverse_distance, x) +
                                          std::fabs(here[x] - there[x]) * inverse_noise[x]);
          weights[x] += w;
          variances[x] += w * w * noise[x];
          red[x] += w * r[x];
          green[x] += w * g[x];
          blue[x] += w * b[x];
        }
      });
      for (size_t x = 0; x < width; ++x) {
        if (!(weights[x] > 0)) continue;  // values near the end of float's range
        const float inverse = 1 / weights[x];
        for (size_t k = 0; k < 3; ++k) result.rgb[k][row + x] = rows[2 + k][x] * inverse;
        result.variance[row + x] = variances[x] * (inverse * inverse);
      }
    }
  });
  return result;
}

bool is_zero(const Plane& plane) {
  return std::all_of(plane.begin(), plane.end(), [](float value) { return value == 0; });
}

void smooth(const Surfaces& s, Signal& signal) {
  signal.variance = signal.variance.empty() ? variance_around(s, brightness_of(signal))
                                            : mean_of_like(s, signal.variance);
  for (int round = 0; round < rounds; ++round) signal = averaged(s, signal, 1 << round);
}

/// A channel, with 0 for what is not finite; zeros where there is none.
Plane plane_of(const Image& image, const std::string& name) {
  const int channel = image.find_channel(name);
  if (channel < 0) return Plane(image.pixel_count());
  const auto values = image.channel(channel);
  Plane plane(values.size());
  for_pixels(plane.size(),
             [&](size_t i) { plane[i] = std::isfinite(values[i]) ? values[i] : 0.0f; });
  return plane;
}

Surfaces surfaces_of(const Image& image) {
  Surfaces s{image.width(), image.height(), {}, {}, {}, plane_of(image, "depth.Z"), {}};
  for (size_t k = 0; k < 3; ++k) {
    s.normal[k] = plane_of(image, std::string("N.") + "XYZ"[k]);
    s.albedo[k] = plane_of(image, std::string("albedo.") + "RGB"[k]);
  }
  s.lightness.resize(s.depth.size());
  for_pixels(s.depth.size(), [&](size_t i) {
    s.lightness[i] = photopic({s.albedo[0][i], s.albedo[1][i], s.albedo[2][i]});
  });
  const auto depth = [&](int x, int y) { return s.depth[size_t(y) * size_t(s.width) + size_t(x)]; };
  const auto step_to = [&](int x, int y, int dx, int dy) {
    const bool inside = x + dx >= 0 && y + dy >= 0 && x + dx < s.width && y + dy < s.height;
    return inside ? std::fabs(depth(x, y) - depth(x + dx, y + dy)) : infinity;
  };
  s.inverse_step.resize(s.depth.size());
  parallel_blocks(size_t(s.height), 16, [&](size_t first, size_t last, size_t) {
    for (int y = int(first); y < int(last); ++y)
      for (int x = 0; x < s.width; ++x) {
        // The lesser of both sides: beyond an outline is another surface.
        const float across = std::min(step_to(x, y, -1, 0), step_to(x, y, 1, 0));
        const float down = std::min(step_to(x, y, 0, -1), step_to(x, y, 0, 1));
        float step = 1e-3f * std::fabs(depth(x, y)) + 1e-12f;  // rounding, and curved surfaces
        for (const float side : {across, down})
          if (std::isfinite(side)) step = std::max(step, side);
        s.inverse_step[size_t(y) * size_t(s.width) + size_t(x)] = 1 / (plane_tolerance * step);
      }
  });
  return s;
}

/// The sum of some layers, with the noise that the image knows.
Signal signal_of(const Image& image, std::initializer_list<const char*> layers, const char* noise) {
  Signal signal;
  if (image.find_channel(noise) >= 0) signal.variance = plane_of(image, noise);
  for (float& value : signal.variance) value = sqr(std::min(std::fabs(value), greatest_noise));
  for (size_t k = 0; k < 3; ++k) {
    signal.rgb[k].resize(image.pixel_count());
    for (const char* layer : layers) {
      const Plane plane = plane_of(image, std::string(layer) + "." + "RGB"[k]);
      for_pixels(plane.size(), [&](size_t i) { signal.rgb[k][i] += plane[i]; });
    }
  }
  return signal;
}

/// Whether there is light, and noise in it that anyone could see: relative to the picture over a
/// hundredth, as far as it is known.
bool is_noisy(const Signal& signal, const Image& image) {
  if (is_zero(signal.rgb[0]) && is_zero(signal.rgb[1]) && is_zero(signal.rgb[2])) return false;
  if (signal.variance.empty()) return true;
  const RgbView picture = rgb_view(image);
  double sum = 0;
  for (size_t i = 0; i < signal.variance.size(); ++i) {
    const float brightness = photopic(picture[i]);
    if (std::isfinite(brightness)) sum += double(signal.variance[i] / (sqr(brightness) + 0.01f));
  }
  return sum > 1e-4 * double(signal.variance.size());
}

/// Adds a part of the light to the picture, or takes it away.
void add(const Signal& signal, float factor, Image& image) {
  for (size_t k = 0; k < 3; ++k) {
    const auto values = image.channel(image.find_channel(std::string(1, "RGB"[k])));
    for_pixels(values.size(), [&](size_t i) { values[i] += factor * signal.rgb[k][i]; });
  }
}

/// Divides light by the albedo, or multiplies it.
void change_by_albedo(const Surfaces& s, bool divide, Signal& signal) {
  const auto albedo = [&](size_t k, size_t i) { return std::max(least_albedo, s.albedo[k][i]); };
  for_pixels(s.lightness.size(), [&](size_t i) {
    for (size_t k = 0; k < 3; ++k)
      signal.rgb[k][i] = divide ? signal.rgb[k][i] / albedo(k, i) : signal.rgb[k][i] * albedo(k, i);
    if (divide && !signal.variance.empty())
      signal.variance[i] /= sqr(photopic({albedo(0, i), albedo(1, i), albedo(2, i)}));
  });
}

}  // namespace

bool can_denoise(const Image& image) {
  const auto has = [&](const char* name) { return image.find_channel(name) >= 0; };
  return std::ranges::all_of(std::array{"R", "G", "B", "albedo.R", "N.X", "depth.Z"}, has) &&
         std::ranges::any_of(std::array{"direct.R", "caustic.R", "indirect.R", "specular.R"},
                             has) &&
         !is_zero(plane_of(image, "depth.Z"));
}

Image denoise(const Image& image) {
  if (!can_denoise(image))
    throw Error(ErrorKind::input, "the image lacks the layers that tell noise from detail",
                "denoise an EXR that kaustik rendered from a camera (not by lighttracer): light by "
                "components, albedo, N and depth");
  if (image.find_metadata("denoised"))
    throw Error(ErrorKind::input, "the image has been denoised before",
                "denoise the one that was rendered");
  const MetadataValue* quantity = image.find_metadata("quantity");
  const bool has_albedo = !quantity || *quantity != MetadataValue("irradiance");
  const Surfaces surfaces = surfaces_of(image);
  Image result = image;
  result.set_metadata("denoised", "true");
  Signal scattered = signal_of(image, {"direct", "caustic", "indirect"}, "noise.scattered");
  if (is_noisy(scattered, image)) {
    add(scattered, -1, result);
    if (has_albedo) change_by_albedo(surfaces, true, scattered);
    smooth(surfaces, scattered);
    if (has_albedo) change_by_albedo(surfaces, false, scattered);
    add(scattered, 1, result);
  }
  Signal mirrored = signal_of(image, {"specular"}, "noise.mirrored");
  if (is_noisy(mirrored, image)) {
    add(mirrored, -1, result);
    smooth(surfaces, mirrored);
    add(mirrored, 1, result);
  }
  return result;
}

}  // namespace kaustik
