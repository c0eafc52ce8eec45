#pragma once
#include <string>
#include <vector>

#include "kaustik/base/vec.h"
#include "kaustik/render/film.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// What a meter shows, with the interval that holds the truth with a chance of 95 %.
struct Measurement {
  Vec3f position{0, 0, 0};  ///< of the meter, m, in the world
  double value = 0;         ///< in the unit of the meter
  double half_width = 0;    ///< of the interval; infinite: not known, with too few passes
};

/// Whether the scene's camera is a meter, which has values rather than a picture.
bool is_meter(const Scene& scene);

/// Of a film of the scene's meter: a value for each of its points or rays; of other meters, whose
/// pixels all show the same, the mean over them. The unit is that of CameraTraits::meter_unit.
std::vector<Measurement> measurements(const Scene& scene, const Film& film);

}  // namespace kaustik
