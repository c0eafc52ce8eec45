#include "kaustik/render/measurements.h"

#include "kaustik/base/photometric_units.h"
#include "kaustik/render/film_errors.h"

namespace kaustik {
namespace {

Measurement measurement(const Vec3f& position, const KnownLuminance& known) {
  const ConfidenceInterval interval = known.interval();
  return {position, lumens_per_watt_white * interval.mean,
          lumens_per_watt_white * interval.half_width};
}

}  // namespace

bool is_meter(const Scene& scene) { return !scene.camera().traits().meter_unit.empty(); }

std::vector<Measurement> measurements(const Scene& scene, const Film& film) {
  const Camera& camera = scene.camera();
  const FilmErrors errors(film);
  if (!camera.traits().are_pixels_apart())
    return {measurement(camera.traits().position,
                        errors.known(PixelRegion{0, 0, film.width(), film.height()}))};
  std::vector<Measurement> list;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const CameraRay ray = camera.sample_ray({float(x) + 0.5f, float(y) + 0.5f}, {});
      if (ray.is_none()) continue;  // the last row may not be full
      list.push_back(
          measurement(ray.origin, errors.known(size_t(y) * size_t(film.width()) + size_t(x))));
    }
  return list;
}

}  // namespace kaustik
