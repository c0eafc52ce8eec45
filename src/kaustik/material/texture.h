#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/spectrum.h"

namespace kaustik {

/// Where a texture is looked up.
struct TextureCoordinates {
  Vec2f uv;
  float footprint = 0;  ///< width of the ray's footprint in uv; 0: a point
};

/// A value that varies over a surface. Immutable.
class Texture {
 public:
  virtual ~Texture() = default;
  virtual Spectrum eval(const TextureCoordinates& at) const = 0;
  /// Upper bound of every lane, for checks ("albedo over 1").
  virtual float maximum() const = 0;
  /// Whether eval() gives the same everywhere.
  virtual bool is_constant() const { return false; }
  /// Mean over the uv square, for importance and previews.
  virtual Spectrum mean() const = 0;
};

/// A texture of one value.
std::shared_ptr<const Texture> make_constant_texture(const Spectrum& value);

struct TextureType {
  const TypeInfo& info;
  std::shared_ptr<const Texture> (*create)(const Arguments&);
};
/// "bitmap", "checkerboard".
const std::vector<TextureType>& texture_types();

}  // namespace kaustik
