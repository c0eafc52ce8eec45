#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/exact_sum.h"
#include "kaustik/image/image.h"
#include "kaustik/integrator/integrator.h"

namespace kaustik {

/// Light of two kinds, whose noise is told apart: what the first surface scatters diffusely (the
/// components direct, caustic and indirect), and what it mirrors and transmits (specular).
inline constexpr int noise_kinds = 2;

/// What one pass makes of one pixel.
struct PassPixel {
  std::array<Spectrum, component_count> radiance{};  ///< mean over the pass's samples, plus splats
  FirstHit first_hit;                                ///< mean over the samples
  /// Mean over the samples of the squared photopic value.
  std::array<float, noise_kinds> squares{};
};

/// Photopic values of the kinds of light.
std::array<float, noise_kinds> by_noise_kind(const std::array<Spectrum, component_count>& radiance);

/// The picture as the sum of its finished passes and of their squares, in exact arithmetic: the
/// same bits in whatever order the passes come.
class Film {
 public:
  /// Throws Error(input) when the picture does not fit into memory.
  Film(const FilmSettings& settings, ComponentSet components);

  /// Adds a finished pass of so many samples per pixel; `pixels` row by row. Not thread-safe.
  void add_pass(const std::vector<PassPixel>& pixels, uint32_t pass_index, uint32_t samples = 1);
  uint32_t pass_count() const { return pass_count_; }
  int width() const { return size_.x; }
  int height() const { return size_.y; }

  /// The mean of the passes: "R" "G" "B", a layer per component, "albedo", "N", "depth", "error"
  /// (standard error of the mean per channel, over passes), and "noise.scattered" and
  /// "noise.mirrored" (of the photopic value, over all samples, as if they were independent: what
  /// denoising goes by; only from two samples per pixel on). All zero without a pass.
  Image image() const;
  /// Half the width of the 95 % confidence interval of the picture's mean luminance, relative to
  /// it: Student's t over the means of the replicates; infinite with fewer than two replicates.
  double mean_error() const;
  /// Square root of the mean over pixels of variance/(mean² + 0.01): how noisy the picture is.
  double relative_noise() const;

 private:
  static constexpr int lanes_ = 3;
  Fixed* sums(size_t pixel) { return sums_.data() + pixel * (component_count * lanes_); }
  const Fixed* sums(size_t pixel) const {
    return sums_.data() + pixel * (component_count * lanes_);
  }
  /// Adds a pixel of a pass and returns its luminance.
  double add_pixel(size_t i, const PassPixel& pixel);
  Spectrum mean(size_t pixel) const;
  double variance_of_mean(size_t pixel, int lane) const;
  /// The same of the kinds of light, over samples.
  std::array<double, noise_kinds> noise(size_t pixel) const;

  Vec2i size_;
  ComponentSet components_;
  uint32_t pass_count_ = 0;
  uint64_t sample_count_ = 0;                            ///< per pixel
  std::vector<Fixed> sums_;                              ///< [pixel][component][lane]
  std::vector<Fixed> squares_;                           ///< [pixel][lane], of the whole radiance
  std::vector<Fixed> first_hits_;                        ///< [pixel][albedo 3, normal 3, depth 1]
  std::vector<Fixed> sample_squares_;                    ///< [pixel][kind of light]
  std::array<Fixed, replicate_count> replicate_sums_{};  ///< of the picture's mean luminance
  std::array<uint32_t, replicate_count> replicate_passes_{};
};

}  // namespace kaustik
