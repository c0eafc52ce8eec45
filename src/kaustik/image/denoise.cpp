#include "kaustik/image/denoise.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/image/cross_filter.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/shrinkage.h"

namespace kaustik {
namespace {

/// What noise is at most, that its square be finite.
constexpr float greatest_noise = 1e15f;

/// What light is divided by where a surface hardly reflects.
constexpr float least_albedo = 0.02f;

/// Noise below this share of the picture's brightness is left: nobody sees it.
constexpr double least_noise = 1e-3;

/// Share of the picture's mean luminance under which a pixel's own counts less and less.
constexpr double dark_share = 0.02;

constexpr const char* error_layer = "denoised_error";

/// Light that is filtered by itself.
struct Part {
  std::vector<std::string> components;
  bool is_scattered = false;    ///< by surfaces, in proportion to their albedo
  const char* noise = nullptr;  ///< the layer that tells it by samples
};

const std::vector<Part>& parts_with_halves() {
  static const std::vector<Part> parts{{{"direct"}, true, "noise.scattered"},
                                       {{"caustic"}, true, "noise.scattered"},
                                       {{"indirect"}, true, "noise.scattered"},
                                       {{"specular"}, false, "noise.mirrored"},
                                       {{"volume"}, false, nullptr}};
  return parts;
}

const Part& scattered_light() {
  static const Part part{{"direct", "caustic", "indirect"}, true, "noise.scattered"};
  return part;
}

/// Of which the noise is known by samples.
const std::vector<Part>& parts_without_halves() {
  static const std::vector<Part> parts{scattered_light(), {{"specular"}, false, "noise.mirrored"}};
  return parts;
}

bool is_zero(const Plane& plane) {
  return std::all_of(plane.begin(), plane.end(), [](float value) { return value == 0; });
}

bool is_black(const std::array<Plane, 3>& rgb) { return std::ranges::all_of(rgb, is_zero); }

Plane brightness_of(const std::array<Plane, 3>& rgb) {
  Plane result(rgb[0].size());
  for_pixels(result.size(), [&](size_t i) {
    result[i] = photopic({rgb[0][i], rgb[1][i], rgb[2][i]});
  });
  return result;
}

std::array<Plane, 3> light_of(const Image& image, const Part& part) {
  std::array<Plane, 3> rgb;
  for (size_t k = 0; k < 3; ++k) {
    rgb[k].resize(image.pixel_count());
    for (const std::string& component : part.components) {
      const Plane plane = plane_of(image, component + "." + "RGB"[k]);
      for_pixels(plane.size(), [&](size_t i) { rgb[k][i] += plane[i]; });
    }
  }
  return rgb;
}

/// A picture on its way.
class Denoising {
 public:
  explicit Denoising(const Image& image);
  Image result();

 private:
  /// A part as it was rendered, and filtered.
  struct Filtered {
    const Part* part;
    std::array<Plane, 3> raw;
    std::array<Plane, 2> shares;  ///< what halves have over the mean, if they are known
    Plane variance;               ///< of the photopic mean, else
    FilteredLight light;
  };

  Filtered with_noise(const Part& part) const;
  bool is_noisy(const Filtered& f) const;
  void filter(Filtered& f) const;
  /// Of what one part is as it was filtered, before the blend.
  Vec3f filtered(const Filtered& f, size_t half, size_t i) const {
    return {f.light.halves[half][0][i], f.light.halves[half][1][i], f.light.halves[half][2][i]};
  }
  Vec3f filtered(const Filtered& f, size_t i) const {
    if (!has_halves_) return filtered(f, 0, i);
    return filtered(f, 0, i) * (1 - odd_share_[i]) + filtered(f, 1, i) * odd_share_[i];
  }
  Vec3f raw(const Filtered& f, size_t i) const { return {f.raw[0][i], f.raw[1][i], f.raw[2][i]}; }
  void find_importance(const std::vector<Filtered>& all);
  void blend(const Filtered& f);

  const Image& image_;
  PixelSurfaces surfaces_;
  bool has_albedo_;  ///< light is in proportion to it
  Plane odd_share_;
  bool has_halves_;
  Plane brightness_;  ///< of the picture
  Plane importance_;  ///< of a squared error
  std::array<Plane, 3> change_;
  std::array<Plane, 2> half_change_, half_light_;
};

Denoising::Denoising(const Image& image)
    : image_(image), surfaces_(image), odd_share_(plane_of(image, "odd.share")) {
  const MetadataValue* quantity = image.find_metadata("quantity");
  has_albedo_ = !quantity || *quantity != MetadataValue("irradiance");
  has_halves_ = std::ranges::all_of(odd_share_, [](float s) { return s > 0 && s < 1; });
  const RgbView picture = rgb_view(image);
  brightness_.resize(image.pixel_count());
  for_pixels(brightness_.size(), [&](size_t i) {
    const float own = photopic(picture[i]);
    brightness_[i] = std::isfinite(own) ? own : 0;
  });
  for (Plane& plane : change_) plane.resize(image.pixel_count());
  if (!has_halves_) return;
  for (size_t half = 0; half < 2; ++half) {
    half_change_[half].resize(image.pixel_count());
    half_light_[half].resize(image.pixel_count());
  }
  // Of all components, those that stay included.
  for (const std::string& name : image.channel_names())
    if (name.starts_with("odd.") && name != "odd.share") {
      const Plane odd = plane_of(image, name);
      for_pixels(odd.size(), [&](size_t i) { half_light_[1][i] += odd[i]; });
    }
  for_pixels(brightness_.size(), [&](size_t i) {
    const float s = odd_share_[i];
    const float most = brightness_[i] / s;
    half_light_[1][i] = std::clamp(half_light_[1][i], std::min(0.0f, most), std::max(0.0f, most));
    half_light_[0][i] = (brightness_[i] - s * half_light_[1][i]) / (1 - s);
  });
}

Denoising::Filtered Denoising::with_noise(const Part& part) const {
  Filtered f{&part, light_of(image_, part), {}, {}, {}};
  const Plane mean = brightness_of(f.raw);
  if (part.noise && image_.find_channel(part.noise) >= 0) {
    f.variance = plane_of(image_, part.noise);
    const bool is_whole = !has_halves_ || !part.is_scattered;
    const Plane whole = is_whole ? mean : brightness_of(light_of(image_, scattered_light()));
    for_pixels(mean.size(), [&](size_t i) {
      // Components have as much noise as light.
      const float share = is_whole       ? 1
                          : whole[i] > 0 ? std::clamp(mean[i] / whole[i], 0.0f, 1.0f)
                                         : 0;
      f.variance[i] = sqr(share * std::min(std::fabs(f.variance[i]), greatest_noise));
    });
  }
  if (!has_halves_) return f;
  const Plane odd = plane_of(image_, "odd." + part.components[0]);
  for (Plane& half : f.shares) half.resize(mean.size());
  for_pixels(mean.size(), [&](size_t i) {
    const float s = odd_share_[i];
    // Rounded, they may be a little more than all.
    const float share = mean[i] > 0 ? std::clamp(odd[i] / mean[i], 0.0f, 1 / s) : 1.0f;
    f.shares[1][i] = share;
    f.shares[0][i] = std::max(0.0f, (1 - s * share) / (1 - s));
  });
  return f;
}

/// Whether there is light, and noise in it that anyone could see, as far as it is known.
bool Denoising::is_noisy(const Filtered& f) const {
  if (is_black(f.raw)) return false;
  if (!has_halves_ && f.variance.empty()) return true;
  const double sum = sum_over_blocks(brightness_.size(), 1 << 14, [&](size_t begin, size_t end) {
    double block = 0;
    for (size_t i = begin; i < end; ++i) {
      const float own = has_halves_ ? sqr(photopic(raw(f, i)) * (f.shares[0][i] - f.shares[1][i])) *
                                          odd_share_[i] * (1 - odd_share_[i])
                                    : f.variance[i];
      block += double(own) / (sqr(double(brightness_[i])) + 0.01);
    }
    return block;
  });
  return sum > sqr(least_noise) * double(brightness_.size());
}

void Denoising::filter(Filtered& f) const {
  NoisyLight light{f.raw, f.shares, f.variance};
  const bool divide = has_albedo_ && f.part->is_scattered;
  const auto albedo = [&](size_t k, size_t i) {
    return std::max(least_albedo, surfaces_.albedo[k][i]);
  };
  if (divide) {
    for (size_t k = 0; k < 3; ++k)
      for_pixels(light.rgb[k].size(), [&](size_t i) { light.rgb[k][i] /= albedo(k, i); });
    for_pixels(light.variance.size(), [&](size_t i) {
      light.variance[i] /= sqr(photopic({albedo(0, i), albedo(1, i), albedo(2, i)}));
    });
  }
  f.light = cross_filtered(surfaces_, light, odd_share_);
  if (!divide) return;
  for (auto& half : f.light.halves)
    for (size_t k = 0; k < 3; ++k)
      for_pixels(half[k].size(), [&](size_t i) { half[k][i] *= albedo(k, i); });
  for_pixels(f.light.variance.size(), [&](size_t i) {
    const float lightness_sq = sqr(photopic({albedo(0, i), albedo(1, i), albedo(2, i)}));
    f.light.variance[i] *= lightness_sq;
    f.light.raw_variance[i] *= lightness_sq;
  });
}

/// Errors count by the brightness of what is seen, as it is when all is filtered.
void Denoising::find_importance(const std::vector<Filtered>& all) {
  importance_ = brightness_;
  for (const Filtered& f : all)
    for_pixels(importance_.size(),
               [&](size_t i) { importance_[i] += photopic(filtered(f, i) - raw(f, i)); });
  const double mean = sum_over_blocks(importance_.size(), 1 << 14,
                                      [&](size_t begin, size_t end) {
                                        double sum = 0;
                                        for (size_t i = begin; i < end; ++i)
                                          sum += double(std::fabs(importance_[i]));
                                        return sum;
                                      }) /
                      double(importance_.size());
  const auto dark = float(dark_share * mean) + 1e-12f;
  for_pixels(importance_.size(),
             [&](size_t i) { importance_[i] = 1 / sqr(std::fabs(importance_[i]) + dark); });
}

void Denoising::blend(const Filtered& f) {
  const size_t count = brightness_.size();
  const auto raw_half = [&](size_t half, size_t i) {
    return photopic(raw(f, i)) * f.shares[half][i];
  };
  const auto half_change = [&](size_t half, size_t i) {
    return photopic(filtered(f, half, i)) - raw_half(half, i);
  };
  Plane share(count);
  if (has_halves_ || !f.variance.empty()) {
    Blend blend{Plane(count),     f.variance,       f.light.raw_variance,
                f.light.variance, f.light.variance, has_halves_};
    for_pixels(count, [&](size_t i) { blend.change[i] = photopic(filtered(f, i) - raw(f, i)); });
    if (has_halves_) {
      blend.own_variance.resize(count);
      for_pixels(count, [&](size_t i) {
        const float s = odd_share_[i], off = raw_half(0, i) - raw_half(1, i);
        blend.own_variance[i] = s * (1 - s) * off * off;
        blend.covariance[i] = s * (1 - s) * off * (off + half_change(0, i) - half_change(1, i));
      });
    }
    share = share_of_raw(surfaces_.width, surfaces_.height, blend, importance_);
  }
  for_pixels(count, [&](size_t i) {
    const Vec3f change = (filtered(f, i) - raw(f, i)) * (1 - share[i]);
    for (size_t k = 0; k < 3; ++k) change_[k][i] += change[int(k)];
    if (!has_halves_) return;
    for (size_t half = 0; half < 2; ++half)
      half_change_[half][i] += (1 - share[i]) * half_change(half, i);
  });
}

Image Denoising::result() {
  std::vector<Filtered> all;
  for (const Part& part : has_halves_ ? parts_with_halves() : parts_without_halves()) {
    Filtered f = with_noise(part);
    if (!is_noisy(f)) continue;
    filter(f);
    all.push_back(std::move(f));
  }
  find_importance(all);
  for (const Filtered& f : all) blend(f);
  Image result = image_;
  result.set_metadata("denoised", "true");
  for (size_t k = 0; k < 3; ++k) {
    const auto values = result.channel(result.find_channel(std::string(1, "RGB"[k])));
    for_pixels(values.size(), [&](size_t i) { values[i] += change_[k][i]; });
  }
  if (!has_halves_) return result;
  const Plane error = error_of_halves(surfaces_.width, surfaces_.height,
                                      {half_light_, half_change_}, odd_share_, importance_);
  // Channels have noise as they had in the picture as it was rendered.
  std::array<Plane, 3> raw;
  for (size_t k = 0; k < 3; ++k) raw[k] = plane_of(image_, std::string("error.") + "RGB"[k]);
  for (size_t k = 0; k < 3; ++k) {
    const auto values =
        result.channel(result.add_channel(std::string(error_layer) + "." + "RGB"[k]));
    for_pixels(values.size(), [&](size_t i) {
      const float whole = photopic({raw[0][i], raw[1][i], raw[2][i]});
      values[i] = whole > 0 ? error[i] * (raw[k][i] / whole) : error[i];
    });
  }
  return result;
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
  return Denoising(image).result();
}

}  // namespace kaustik
