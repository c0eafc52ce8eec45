#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/exact_sum.h"
#include "kaustik/image/image.h"
#include "kaustik/render/pass_set.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

class BinaryReader;
class BinaryWriter;
class FilmErrors;

/// Light of two kinds, whose noise is told apart: what the first surface scatters diffusely (the
/// components direct, caustic and indirect), and what it mirrors and transmits (specular).
inline constexpr int noise_kinds = 2;

/// Estimates of the bias are summed apart for even and for odd replicates.
inline constexpr uint32_t bias_halves = 2;

/// What one pass makes of one pixel.
struct PassPixel {
  std::array<Spectrum, component_count> radiance{};  ///< mean over the pass's samples, plus splats
  FirstHit first_hit;                                ///< mean over the samples
  /// Mean over the samples of the squared photopic value.
  std::array<float, noise_kinds> squares{};
  Spectrum bias;  ///< mean over the samples
  /// Camera samples; 0: as many as add_pass() says.
  uint32_t samples = 0;
};

/// Photopic values of the kinds of light.
std::array<float, noise_kinds> by_noise_kind(const std::array<Spectrum, component_count>& radiance);

/// What a film holds beside what all of them do.
struct FilmLayers {
  ComponentSet components;
  bool bias = false;  ///< estimates of the bias
  static FilmLayers of(const Integrator& integrator) {
    return {integrator.traits().components, integrator.traits().estimates_bias};
  }
  friend bool operator==(const FilmLayers&, const FilmLayers&) = default;
};

/// The picture as the sum of its finished passes and of their squares, in exact arithmetic: the
/// same bits in whatever order the passes come, and whether they come one by one or as another
/// film's sums.
class Film {
 public:
  /// Throws Error(input) when the picture does not fit into memory.
  Film(const FilmSettings& settings, const FilmLayers& layers);

  /// Adds a finished pass of so many samples per pixel on average, which must not be there yet;
  /// `pixels` row by row. Not thread-safe.
  void add_pass(const std::vector<PassPixel>& pixels, uint32_t pass_index, uint32_t samples = 1);
  /// Adds the passes of another film of this size and these layers; none may be in both.
  void add(const Film& other);
  bool is_like(const Film& other) const { return is_for(other.size_, other.layers_); }
  /// Whether it holds pictures of this size and these layers.
  bool is_for(Vec2i size, const FilmLayers& layers) const {
    return size_ == size && layers_ == layers;
  }
  const PassSet& passes() const { return passes_; }
  uint32_t pass_count() const { return passes_.count(); }
  /// On average.
  uint64_t samples_per_pixel() const { return sample_count_; }
  int width() const { return size_.x; }
  int height() const { return size_.y; }
  size_t pixel_count() const { return size_t(size_.x) * size_t(size_.y); }
  bool holds_bias() const { return layers_.bias; }

  /// The mean of the passes: "R" "G" "B", a layer per component, "albedo", "N", "depth", "error"
  /// (standard error of the mean per channel, see FilmErrors), "bias" where the integrator
  /// estimates it (how much the picture is expected to be too bright, per channel), and
  /// "noise.scattered" and "noise.mirrored" (of the photopic value, over all samples, as if they
  /// were independent: what denoising goes by; only from two samples per pixel on). All zero
  /// without a pass.
  Image image() const;
  /// FilmErrors::of_mean()
  double mean_error() const;
  /// FilmErrors::of_picture()
  double picture_error() const;

  /// The sums as part of a file, and back; reading throws as BinaryReader does.
  void write(BinaryWriter& writer) const;
  static Film read(BinaryReader& reader);

  // What errors are computed from; all but the means are sums over passes.
  double total(size_t pixel, int lane) const;  ///< over the components
  double total_squares(size_t pixel, int lane) const { return sum(pixel, squares_ + size_t(lane)); }
  double luminance_squares(size_t pixel) const { return sum(pixel, luminance_squares_); }
  /// By replicate.
  const Fixed* replicate_luminances(size_t pixel) const {
    return sums(pixel) + replicate_luminances_;
  }
  /// Of the picture's mean luminance, by replicate.
  const std::array<Fixed, replicate_count>& mean_luminances() const { return mean_luminances_; }
  /// Only if holds_bias().
  Vec3f mean_bias(size_t pixel) const;
  /// Of the passes of even replicates (0) or of odd ones (1): independent of one another.
  Vec3f bias_sum(size_t pixel, size_t half) const;

 private:
  static constexpr int lanes_ = 3;
  // What is summed per pixel, and where it stands among the pixel's numbers.
  static constexpr size_t radiance_ = 0;  ///< [component][lane]
  static constexpr size_t squares_ =
      radiance_ + component_count * lanes_;                ///< [lane], of the whole
  static constexpr size_t first_hit_ = squares_ + lanes_;  ///< [albedo 3, normal 3, depth 1]
  static constexpr size_t first_hit_lanes_ = 7;
  static constexpr size_t sample_squares_ = first_hit_ + first_hit_lanes_;  ///< [kind of light]
  /// One over the samples of a pass: passes count alike.
  static constexpr size_t inverse_samples_ = sample_squares_ + noise_kinds;
  static constexpr size_t luminance_squares_ = inverse_samples_ + 1;
  static constexpr size_t replicate_luminances_ = luminance_squares_ + 1;  ///< [replicate]
  static constexpr size_t bias_ =
      replicate_luminances_ + replicate_count;  ///< [half][lane], if held

  Film(Vec2i size, const FilmLayers& layers) : size_(size), layers_(layers) {}
  static void check_size(const FilmSettings& settings, size_t numbers_per_pixel);
  size_t numbers_per_pixel() const { return layers_.bias ? bias_ + bias_halves * lanes_ : bias_; }
  Fixed* sums(size_t pixel) { return numbers_.data() + pixel * numbers_per_pixel(); }
  const Fixed* sums(size_t pixel) const { return numbers_.data() + pixel * numbers_per_pixel(); }
  double sum(size_t pixel, size_t number) const { return double_from(sums(pixel)[number]); }
  /// Adds a pixel of a pass and returns its luminance.
  double add_pixel(size_t i, const PassPixel& pixel, size_t replicate, uint32_t samples);
  /// The pixel's values in the image's order of channels.
  std::vector<float> values(size_t pixel, const FilmErrors& errors) const;
  bool knows_noise() const { return sample_count_ >= 2; }
  Spectrum mean(size_t pixel) const;
  Spectrum mean(size_t pixel, Component component) const;
  /// Standard errors of the kinds of light, over samples.
  std::array<double, noise_kinds> noise(size_t pixel) const;

  Vec2i size_;
  FilmLayers layers_;
  PassSet passes_;
  uint64_t sample_count_ = 0;   ///< per pixel, on average
  std::vector<Fixed> numbers_;  ///< [pixel][number]
  std::array<Fixed, replicate_count> mean_luminances_{};
};

}  // namespace kaustik
