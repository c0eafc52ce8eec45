#pragma once
#include <array>
#include <memory>
#include <vector>

#include "kaustik/render/pixel_region.h"
#include "kaustik/transport/integrator.h"
#include "kaustik/transport/picture_tiles.h"

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
  Spectrum bias;  ///< mean over the samples
  /// Camera samples; 0: as many as Film::add_pass() says.
  uint32_t samples = 0;
};

/// Photopic values of the kinds of light.
std::array<float, noise_kinds> by_noise_kind(const std::array<Spectrum, component_count>& radiance);

/// The picture of one pass, tile by tile: what is zero all over a tile takes no memory there, what
/// is the same all over it hardly any. Threads may store different tiles at the same time.
class PassTiles {
 public:
  using Pixels = std::array<PassPixel, PictureTiles::pixels>;
  using Line = std::array<float, PictureTiles::pixels>;  ///< one number of a tile's pixels

  // The numbers of a pixel, in lanes of RGB.
  static constexpr size_t radiance = 0;                                ///< [component][lane]
  static constexpr size_t first_hit = radiance + component_count * 3;  ///< [albedo 3, normal 3,
                                                                       ///< depth 1, lamps 1]
  static constexpr size_t lamps = first_hit + 7;
  static constexpr size_t squares = lamps + 1;
  static constexpr size_t bias = squares + noise_kinds;
  static constexpr size_t line_count = bias + 3;

  explicit PassTiles(const Vec2i& size) : tiles_(size), stored_(tiles_.count()) {}

  const PictureTiles& tiles() const { return tiles_; }
  /// All zero where nothing was stored.
  void load(size_t tile, Pixels& pixels) const;
  void store(size_t tile, const Pixels& pixels);
  /// One number of a tile's pixels, as long as the pass is not changed; null: zero all over.
  /// `uniform` is used where it is the same all over.
  const Line* read(size_t tile, size_t line, Line& uniform) const;
  void read_samples(size_t tile, std::array<uint32_t, PictureTiles::pixels>& samples) const;
  /// Those pixels, as a picture of their own.
  PassTiles cut_out(const PixelRegion& region) const;
  /// Of all pixels of the picture.
  uint32_t fewest_samples() const;
  void clear();
  /// That it takes.
  size_t bytes() const;

 private:
  enum class Kind : uint8_t { zero, uniform, full };
  struct StoredTile {
    std::array<Kind, line_count + 1> kinds{};  ///< of the lines, then of the samples
    std::vector<float> numbers;  ///< of uniform lines one, of full ones all; samples as their bits
  };
  static size_t size_of(Kind kind);

  PictureTiles tiles_;
  std::vector<StoredTile> stored_;
};

}  // namespace kaustik
