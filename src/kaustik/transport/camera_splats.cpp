#include "kaustik/transport/camera_splats.h"

namespace kaustik {

struct CameraSplats::Sight {
  const SurfacePoint& from;  ///< without normals in a medium
  const Medium* medium;      ///< that it begins in
  const CameraConnection& connection;
  LightOnItsWay of;
  std::optional<Spectrum> visible = std::nullopt;  ///< once it is known
};

SurfaceVertex CameraSplats::seen(SurfaceVertex vertex, const CameraConnection& connection) const {
  if (wants_irradiance())
    vertex.paint_white();
  else
    vertex.look_up_from(scene_, connection.direction,
                        scene_.camera().traits().pixel_width +
                            scene_.camera().traits().pixel_spread * connection.distance);
  return vertex;
}

void CameraSplats::add(Component component, const Spectrum& value, Sight& sight) {
  if (value.is_zero()) return;
  if (!sight.visible) {
    const Ray ray = spawn_ray_to(sight.from, sight.connection.lens);
    sight.visible =
        wants_irradiance()
            ? Spectrum(is_unobstructed(scene_, ray, rays_, ShadowRayTo::camera) ? pi : 0.0f)
            : shadow_ray_transmittance(scene_, ray, sight.medium, sight.of, rays_,
                                       ShadowRayTo::camera);
    if (!sight.visible->is_zero()) ++shown_;
  }
  if (!sight.visible->is_zero())
    splats_.add(sight.connection.raster, component, value * *sight.visible, sight.of.wavelengths);
}

void CameraSplats::add(const LightVertex& at, const SurfaceVertex& vertex,
                       const CameraConnection& connection, float weight) {
  Sight sight{vertex.point(),
              vertex.medium_toward(connection.direction, at.state.medium),
              connection,
              {at.state.wavelengths, at.sampler}};
  for (const Lobes lobes : {Lobes::diffuse, Lobes::glossy}) {
    const Component component = at.path_class.component_seen_by(lobes);
    if (any(vertex.lobes() & lobes) && wanted_.has(component))
      add(component,
          at.state.throughput * vertex.eval_cosine(connection.direction, lobes) *
              scale(connection, weight),
          sight);
  }
}

void CameraSplats::add(const LightMediumVertex& at, const CameraConnection& connection,
                       float weight) {
  SurfacePoint point;
  point.position = at.position;
  Sight sight{point, &at.medium, connection, {at.state.wavelengths, at.sampler, true}};
  add(Component::volume,
      at.flux * at.medium.phase().eval(at.wo, connection.direction) * scale(connection, weight),
      sight);
}

void CameraSplats::show_lamp(int light, const SurfacePoint& origin, float pdf_area,
                             const LightOnItsWay& of) {
  const Light& lamp = *scene_.lights()[size_t(light)];
  if (!wanted_.has(Component::emission) || wants_irradiance() || scene_.is_hidden(light)) return;
  if (lamp.traits().is_beam()) return;
  const CameraConnection connection = connect(origin.position, of.sampler);
  const float cosine = dot(connection.direction, origin.ng);
  if (!(connection.importance > 0 && cosine > 0 && pdf_area > 0)) return;
  const Spectrum radiance = lamp.emitted(origin, connection.direction, of.wavelengths);
  for_all_rasters(connection, [&](const CameraConnection& one) {
    Sight sight{origin, scene_.light_medium(light), one, of};
    add(Component::emission, radiance * (cosine / pdf_area) * scale(one, 1), sight);
  });
}

}  // namespace kaustik
