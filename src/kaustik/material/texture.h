#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/spectral_value.h"

namespace kaustik {

class PictureReader;

/// Where a texture is looked up: a point with the footprint of the ray that asks, a disk as large
/// as the ellipse that the ray's cone cuts out of the surface (its long axis is not followed).
struct TextureCoordinates {
  Vec2f uv{0, 0};
  Vec2f uv_width{0, 0};     ///< extent of the footprint along u and v, in uv; 0: a point
  Vec3f position{0, 0, 0};  ///< m, in the space where the shape was described: the world, or that
                            ///< of its shape group
  Vec3f normal{0, 0, 0};    ///< geometric, in the same space
  float width = 0;          ///< of the footprint, m, in the same space; 0: a point
};

/// How a height changes from place to place, m per unit of uv and m per m.
struct HeightGradient {
  Vec2f uv{0, 0};
  Vec3f position{0, 0, 0};
};

/// A value that varies over a surface, or in space: a colour, or one number. Immutable. All answers
/// are means over the footprint, or near to that; over many places their mean is that of the
/// texture itself, whatever the footprint.
class Texture {
 public:
  virtual ~Texture() = default;
  /// As a colour that reflects, or as another factor.
  virtual Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const = 0;
  /// As one number, for parameters that are no colours (roughness, opacity, weights): the luminance
  /// of the colour in RGB mode, as in Mitsuba, whatever wavelengths the picture is rendered at.
  virtual float scalar(const TextureCoordinates& at) const;
  /// Upper bound of every lane in RGB mode, for checks ("albedo over 1").
  virtual float maximum() const = 0;
  /// Width over height of the picture that it is; 1 if it is none.
  virtual float aspect() const { return 1; }
  /// Whether eval() gives the same everywhere.
  virtual bool is_constant() const { return false; }
  /// Mean over the uv square in RGB mode, for importance and previews; of textures in space
  /// over a large volume.
  virtual Spectrum mean() const = 0;

  /// Gradient of the height, m, of the relief that goes with the texture; for textures that know of
  /// none the height is scalar().
  virtual HeightGradient height_gradient(const TextureCoordinates& at) const = 0;
};

/// Weighted by the eye's sensitivity, such that white of 1 gives 1. `rgb`: lanes in RGB mode.
float luminance_of(const Spectrum& rgb);

/// A texture of one value.
std::shared_ptr<const Texture> make_constant_texture(const SpectralValue& value);

struct TextureType {
  const TypeInfo& info;
  /// Pictures come from the reader.
  std::shared_ptr<const Texture> (*create)(const Arguments&, PictureReader&);
};
/// "bitmap", "checkerboard", "noise", "marble", "wood", "tiles", "waves".
const std::vector<TextureType>& texture_types();

}  // namespace kaustik
