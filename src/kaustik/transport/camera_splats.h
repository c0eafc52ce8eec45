#pragma once
#include <optional>

#include "kaustik/transport/light_path.h"
#include "kaustik/transport/splat_buffer.h"
#include "kaustik/transport/visibility.h"

namespace kaustik {

/// Shows the camera what light paths meet: each vertex by a point of the lens that a fork of the
/// path's numbers tells, as far as nothing stands between. Where the film asks for irradiance,
/// surfaces are painted white and count π times, whatever stands in a medium between, and nothing
/// else is shown. Textures are those that the camera sees, whatever footprint the light has there:
/// paths from both ends find the same. Not thread-safe but for `splats`, which many may add to.
class CameraSplats {
 public:
  /// `paths`: how many there are, each of which stands for all light. All must outlive this.
  CameraSplats(const Scene& scene, const ComponentSet& wanted, uint32_t paths, SplatBuffer& splats)
      : scene_(scene), wanted_(wanted), paths_(float(paths)), splats_(splats) {}

  /// What the surface sends to the camera. `weigh(connection, vertex)`: how much the path counts
  /// where it is found like this, `vertex` being that which is seen.
  template <typename Weigh>
  void show(const LightVertex& at, const Weigh& weigh) {
    if (!wants_irradiance() && !any(at.vertex.lobes() & (Lobes::diffuse | Lobes::glossy))) return;
    if (scene_.is_hidden(at.vertex.light())) return;
    const CameraConnection connection = connect(at.vertex.position(), at.sampler);
    if (!(connection.importance > 0)) return;
    std::optional<SurfaceVertex> as_seen;
    if (wants_irradiance() || at.vertex.has_textures()) as_seen = seen(at.vertex, connection);
    const SurfaceVertex& vertex = as_seen ? *as_seen : at.vertex;
    const float weight = weigh(connection, vertex);
    if (weight > 0) add(at, vertex, connection, weight);
  }
  /// What the medium scatters to the camera. `weigh(connection)` as above.
  template <typename Weigh>
  void show(const LightMediumVertex& at, const Weigh& weigh) {
    if (!wanted_.has(Component::volume) || wants_irradiance()) return;
    const CameraConnection connection = connect(at.position, at.sampler);
    if (!(connection.importance > 0)) return;
    const float weight = weigh(connection);
    if (weight > 0) add(at, connection, weight);
  }
  /// The lamp itself, where a path begins on its surface with that density; `of` is the path's.
  void show_lamp(int light, const SurfacePoint& origin, float pdf_area, const LightOnItsWay& of);

  uint64_t rays() const { return rays_; }
  /// Vertices that the camera sees.
  uint64_t shown() const { return shown_; }

 private:
  /// A way to the camera, on which rays are traced once they are needed.
  struct Sight;
  bool wants_irradiance() const { return scene_.film().quantity == Quantity::irradiance; }
  CameraConnection connect(const Vec3f& point, const Sampler& sampler) const {
    const Camera& camera = scene_.camera();
    return camera.connect(point, camera.forked_lens_numbers(sampler));
  }
  /// What a light path has met, as it is in the picture.
  SurfaceVertex seen(SurfaceVertex vertex, const CameraConnection& connection) const;
  /// Turns what a path sends to the camera, W/sr, into radiance of the pixel.
  float scale(const CameraConnection& connection, float weight) const {
    return weight * connection.importance / (sqr(connection.distance) * paths_);
  }
  void add(const LightVertex& at, const SurfaceVertex& vertex, const CameraConnection& connection,
           float weight);
  void add(const LightMediumVertex& at, const CameraConnection& connection, float weight);
  void add(Component component, const Spectrum& value, Sight& sight);

  const Scene& scene_;
  const ComponentSet wanted_;
  const float paths_;
  SplatBuffer& splats_;
  uint64_t rays_ = 0, shown_ = 0;
};

}  // namespace kaustik
