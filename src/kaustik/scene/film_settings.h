#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"
#include "kaustik/scene/pixel_filter.h"

namespace kaustik {

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
  float exposure = 0;  ///< doublings of the light where it is shown; no change of the light itself
  bool is_spectral = false;  ///< light is followed at wavelengths, and not as red, green and blue
  bool layers = true;        ///< images hold components, what is seen, errors and noise
};

struct FilmType {
  const TypeInfo& info;
  /// The settings but for the filter and what other objects say. Throws Error(input) for a crop
  /// window that leaves the picture.
  FilmSettings (*create)(const Arguments&);
};
/// "hdrfilm", the first, and what it stands for.
const std::vector<FilmType>& film_types();

/// Tables of the samplers.
const std::vector<TypeInfo>& sampler_infos();

}  // namespace kaustik
