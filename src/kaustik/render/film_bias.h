#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "kaustik/render/film.h"
#include "kaustik/render/film_parts.h"

namespace kaustik {

/// How far off a film's pixels are expected to be, by the estimates that its integrator has made
/// (SampleSink::add_bias).
///
/// Estimates are as noisy as the picture, and the square of noise is not zero. But the product of
/// two independent ones has the mean of the bias squared: b₁ of even replicates, b₂ of odd ones,
/// relative to the pixel's light. Means over a window around the pixel are weighted by the light:
/// what is dark beside an edge is all bias, and does not speak for the bright. B is that of b₁ b₂.
/// C = mean(b₁) mean(b₂), held to 0 … B, is what the window has in common: light that bends
/// smoothly. There only smooth_bias_share of the estimates is right. The rest changes sign within
/// the window, as at edges of light, where estimates are right: so the bias squared is B − C +
/// smooth_bias_share² C. (Averages of signed estimates would lose that rest.)
///
/// Where a pixel's own estimate is larger, and more than three times its standard error, that
/// counts: a line of light is narrower than the window.
class FilmBias {
 public:
  /// Of R, G and B, then of the luminance.
  static constexpr size_t luminance = 3, channels = 4;

  /// The film has to hold bias, and need not outlive this; `parts` must.
  FilmBias(const Film& film, const FilmParts& parts);

  /// Whether some pixel has passes of both halves.
  bool is_known() const { return is_known_; }
  /// Sum over the passes.
  const Vec3f& sum(size_t pixel) const { return sums_[pixel]; }

  /// By pixel, in the picture's unit, squared. Pixels without passes of both halves have none.
  struct Squares {
    std::vector<float> of_pixel;  ///< as it counts for the pixel
    // Of the luminance alone:
    std::vector<float> around;  ///< of the window; may be negative, which over many pixels cancels
    /// Of a pixel's bias, as far as the window shares it.
    std::vector<float> variance;
  };
  /// Of one channel. `light`: by pixel, above 0, in the picture's unit. `apart`: pixels have
  /// nothing to do with one another. Only if it is known.
  Squares squares(size_t channel, const std::vector<double>& light, bool apart) const;

 private:
  struct RowRange {
    int begin, end;
  };
  void square_rows(size_t channel, const std::vector<double>& light, bool apart,
                   const RowRange& rows, Squares& result) const;

  static bool has_halves(const PassCounts& counts) {
    return counts.of_half(0) > 0 && counts.of_half(1) > 0;
  }

  const FilmParts& parts_;
  Vec2i size_;
  bool is_known_ = false;
  std::vector<Vec3f> sums_;
  /// Means over the passes of each half; 0 where a half has none.
  std::vector<std::array<Vec3f, bias_halves>> halves_;
};

}  // namespace kaustik
