#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// The pixel filter, normalised to integral 1 over the raster plane. Camera rays are drawn from it,
/// so every sample belongs to one pixel alone; splats are weighted by it.
class PixelFilter {
 public:
  enum class Kind { box, tent, gaussian };
  PixelFilter() = default;
  PixelFilter(Kind kind, float radius, float stddev);

  /// Offset from the pixel's centre, in pixels.
  Vec2f sample(const Vec2f& u) const;
  /// Density of that offset; zero beyond radius().
  float eval(const Vec2f& offset) const { return eval_1d(offset.x) * eval_1d(offset.y); }
  float radius() const { return radius_; }

 private:
  float eval_1d(float x) const;
  float sample_1d(float u) const;

  Kind kind_ = Kind::box;
  float radius_ = 0.5f;
  float stddev_ = 0.5f;
  float gaussian_offset_ = 0, gaussian_norm_ = 1;
  /// Of the Gaussian's distribution function: its values at evenly spaced offsets, and for evenly
  /// spaced values the last of these below.
  struct Table {
    std::vector<float> cdf;
    std::vector<uint16_t> guide;
  };
  std::shared_ptr<const Table> table_;
};

/// What the picture holds.
enum class Quantity : uint8_t {
  radiance,   ///< that arrives at the camera, W/(sr·m²)
  irradiance  ///< W/m², on the side that is seen of the first surface behind each pixel
};

/// Size of the picture and what is recorded.
struct FilmSettings {
  Vec2i size{768, 576};  ///< of the whole picture
  Vec2i crop_offset{0, 0};
  Vec2i crop_size{768, 576};  ///< what is rendered
  PixelFilter filter;
  int sample_count = 0;  ///< the scene file's samples per pixel; 0: not given
  Place place = {};      ///< in the scene file
  Quantity quantity = Quantity::radiance;
  bool layers = true;  ///< images hold components, what is seen, errors and noise
};

struct FilmType {
  const TypeInfo& info;
  /// The settings but for the filter and what other objects say. Throws Error(input) for a crop
  /// window that leaves the picture.
  FilmSettings (*create)(const Arguments&);
};
/// "hdrfilm".
const std::vector<FilmType>& film_types();

/// Tables of the filters and the samplers.
const std::vector<TypeInfo>& filter_infos();
const std::vector<TypeInfo>& sampler_infos();

}  // namespace kaustik
