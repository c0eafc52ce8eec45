#include "photon_picture.h"

#include <algorithm>
#include <cmath>

namespace kaustik::thesis {
namespace {

constexpr float dot_radius = 1.1f;  ///< pixels
constexpr float surface_brightness = 0.12f;

}  // namespace

PhotonPicture::PhotonPicture(const Scene& scene, const Image& first_hits)
    : scene_(scene), image_(first_hits.width(), first_hits.height(), {"R", "G", "B"}) {
  const RgbView albedo = rgb_view(first_hits, "albedo"), normal = rgb_view(first_hits, "N");
  const Vec3f light = normalize({0.3f, 0.9f, 0.4f});
  for (size_t i = 0; i < image_.pixel_count(); ++i) {
    // Shaded as if from above on the side that is seen, so that edges can be told.
    const float shade = surface_brightness * (0.6f + 0.4f * std::fabs(dot(normal[i], light)));
    for (int c = 0; c < 3; ++c) image_.channel(c)[i] = albedo.planes[size_t(c)][i] * shade;
  }
}

void PhotonPicture::add(const Vec3f& position, const Vec3f& color) {
  const CameraConnection seen = scene_.camera().connect(position, Camera::middle_of_lens());
  if (!(seen.importance > 0)) return;
  // Photons lie on surfaces: a thousandth before the point nothing of that surface is in the way.
  Ray ray{seen.lens, seen.direction * -1.0f};
  ray.t_max = seen.distance * 0.999f;
  if (scene_.occluded(ray)) return;
  const int x0 = int(std::floor(seen.raster.x - dot_radius)),
            y0 = int(std::floor(seen.raster.y - dot_radius));
  for (int y = y0; y <= y0 + 3; ++y)
    for (int x = x0; x <= x0 + 3; ++x) {
      if (x < 0 || y < 0 || x >= image_.width() || y >= image_.height()) continue;
      const float distance =
          std::hypot(float(x) + 0.5f - seen.raster.x, float(y) + 0.5f - seen.raster.y);
      const float cover = std::clamp(dot_radius + 0.5f - distance, 0.0f, 1.0f);
      for (int c = 0; c < 3; ++c) {
        float& value = image_.at(x, y, c);
        value = std::max(value, cover * color[c]);
      }
    }
}

}  // namespace kaustik::thesis
