#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/spectral_value.h"
#include "kaustik/volume/volume.h"

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
  uint32_t primitive = 0;   ///< that the point lies on, see SurfacePoint
};

/// What a surface tells of its points beside geometry: a colour, or a number. Immutable.
class SurfaceAttribute {
 public:
  virtual ~SurfaceAttribute() = default;
  /// Linear Rec. 709, finite; a number stands in all three places. `position` as in
  /// TextureCoordinates.
  virtual Vec3f at(uint32_t primitive, const Vec3f& position) const = 0;
  /// How the sum of the three times `weights` changes with the position, per m.
  virtual Vec3f gradient(uint32_t primitive, const Vec3f& weights) const = 0;
  /// Over the surface's area.
  virtual Vec3f mean() const = 0;
  /// Upper bound of all three.
  virtual float maximum() const = 0;
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
  /// Pixels of the picture that it is; 0: none.
  virtual Vec2i resolution() const { return {0, 0}; }
  /// Whether eval() gives the same everywhere.
  virtual bool is_constant() const { return false; }
  /// Mean over the uv square in RGB mode, for importance and previews; of textures in space
  /// over a large volume.
  virtual Spectrum mean() const = 0;

  /// Gradient of the height, m, of the relief that goes with the texture; for textures that know of
  /// none the height is scalar().
  virtual HeightGradient height_gradient(const TextureCoordinates& at) const = 0;

  /// How many textures an answer asks at most, itself included; one that is nested in several
  /// places counts for each of them.
  virtual int size() const { return 1; }
};

/// The largest size that a scene may use: textures that share nested ones double it at each level.
inline constexpr int maximum_texture_size = 256;

/// Weighted by the eye's sensitivity, such that white of 1 gives 1. `rgb`: lanes in RGB mode.
float luminance_of(const Spectrum& rgb);

/// A texture of one value.
std::shared_ptr<const Texture> make_constant_texture(const SpectralValue& value);

/// What stands for `textured()` parameters: the nested texture if there is one, else a constant one
/// from the argument; null if there is neither.
using TextureOfParameter = std::function<std::shared_ptr<const Texture>(std::string_view)>;

/// The nested volume that stands for a parameter; null if there is none.
using VolumeOfParameter = std::function<std::shared_ptr<const Volume>(std::string_view)>;

/// What create() of a texture gets.
struct TextureInputs {
  const Arguments& arguments;
  PictureReader& pictures;  ///< where pictures come from
  TextureOfParameter texture;
  /// What the surface that the texture lies on tells under a name; null where there is no surface
  /// and the texture is only checked. Throws Error(input) where the surface has nothing of the
  /// name.
  std::function<std::shared_ptr<const SurfaceAttribute>(const std::string& name)> attribute;
  VolumeOfParameter volume;
};

struct TextureType {
  const TypeInfo& info;
  /// Throws Error(input) where arguments contradict one another, or pictures cannot be read.
  std::shared_ptr<const Texture> (*create)(const TextureInputs&);
  /// Whether each surface that it lies on has one of its own, which knows the surface's attributes.
  bool asks_surface = false;
};
/// "bitmap", "checkerboard", "gridtexture", "scale", "mesh_attribute", "volume", "noise", "marble",
/// "wood", "tiles", "waves".
const std::vector<TextureType>& texture_types();

}  // namespace kaustik
