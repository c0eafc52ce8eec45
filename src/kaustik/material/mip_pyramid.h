#pragma once
#include <vector>

#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// What lies outside of a picture: itself again, its mirror image, its edge, black or white.
enum class Wrap { repeat, mirror, clamp, zero, one };

/// The same along u and along v.
struct Wraps {
  Wraps(Wrap both) : u(both), v(both) {}  // NOLINT: a wrap is both
  Wraps(Wrap along_u, Wrap along_v) : u(along_u), v(along_v) {}
  Wrap u, v;
};

/// A picture with its reductions to about half the size each, down to one texel; every one has the
/// same mean, whatever the size (Williams, "Pyramidal Parametrics", SIGGRAPH 1983). Coordinates
/// are those of the unit square, v = 0 its upper edge.
class MipPyramid {
 public:
  /// `texels` row by row from the upper left.
  MipPyramid(int width, int height, std::vector<Spectrum> texels, const Wraps& wraps);

  /// The texel at a point of the full picture.
  const Spectrum& nearest(const Vec2f& uv) const;
  /// Mean over about `uv_width`, by bilinear lookups in the two reductions next in size.
  Spectrum filtered(const Vec2f& uv, const Vec2f& uv_width) const;
  /// Size of a texel of the reduction that is as coarse as `uv_width` (of the picture itself at
  /// least), in uv.
  Vec2f texel_size(const Vec2f& uv_width) const;
  Spectrum mean() const { return levels_.back().texels.front(); }

 private:
  struct Level {
    int width, height;
    std::vector<Spectrum> texels;
  };
  Vec2f wrapped(const Vec2f& uv) const;
  const Spectrum& texel(const Level& level, int x, int y) const;
  Spectrum bilinear(const Level& level, const Vec2f& uv) const;
  /// Whose texels are as wide as the footprint, as a fraction between levels.
  float level_of(const Vec2f& uv_width) const;

  std::vector<Level> levels_;
  Wraps wraps_;
};

}  // namespace kaustik
