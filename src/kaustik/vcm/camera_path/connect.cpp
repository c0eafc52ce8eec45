#include "kaustik/vcm/camera_path/connect.h"

#include <algorithm>

#include "kaustik/transport/visibility.h"

namespace kaustik {
namespace {

/// Density per solid angle with which a light path goes on from its vertex `at`.
float pdf_of_light(const CameraPathInputs& in, const Scatterer& at, const Vec3f& to) {
  const float plain = at.pdf(to, Lobes::all);
  if (!in.scattering || at.is_in_medium()) return plain;
  return in.scattering->place(*at.surface(), at.wo()).pdf(plain, to);
}

void connect_to(const ConnectibleVertex& to, const CameraPathInputs& in,
                const CameraVertices& vertices, CameraWalk& walk) {
  // Events: those of the walk, at both vertices, and between the light and `to`.
  if (walk.events() + 1 + int(to.data.before) > in.maximum_events) return;
  const Scatterer& vertex = vertices.here();
  SurfaceVertex surface;
  if (!to.in_medium)
    surface.meet(in.scene, to.ray, to.hit, TransportMode::flux, {}, walk.wavelengths());
  const Scatterer other =
      to.in_medium ? Scatterer(to.ray.origin, -to.ray.direction, *to.medium) : Scatterer(surface);
  const Vec3f between = other.position() - vertex.position();
  const float distance_sq = length_sq(between);
  if (!(distance_sq > 0)) return;
  const Vec3f direction = between * (1 / std::sqrt(distance_sq));
  const PathVertex& other_data = in.light.at(to.data);
  PathHalves path = vertices.halves();
  if (const SurfaceVertex* at = vertex.surface(); at && vertices.is_at_first())
    path.first_survival = vertices.counted_survival_toward(at->values(direction));
  path.light = {in.light.vertices.data() + to.data.path, size_t(to.data.before) + 1};
  path.pdf_light_last =
      pdf_of_light(in, other, -direction) * vertex.facing().factor(direction) / distance_sq;
  path.pdf_light_before_last = vertices.pdf_light_before(direction);
  path.pdf_camera_last =
      vertex.pdf(direction, Lobes::all) * other.facing().factor(direction) / distance_sq;
  path.pdf_camera_before_last = other.pdf_reverse(-direction, Lobes::all) * other_data.to_previous;
  path.pdf_next_event = to.data.pdf_next_event;
  const float weight = in.weights.connection(path);
  if (!(weight > 0)) return;
  const Spectrum arriving = to.data.flux.spectrum() * (weight * in.connection_scale / distance_sq);
  const bool is_rough = vertex.is_in_medium() || other.is_in_medium();
  Spectrum visible;
  bool traced = false;
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
    if (!any(vertex.lobes() & lobe)) continue;
    const Spectrum reflected = vertex.eval_cosine(direction, lobe);
    if (reflected.is_zero()) continue;
    for (const Lobes other_lobe : {Lobes::diffuse, Lobes::glossy}) {
      if (!any(other.lobes() & other_lobe)) continue;
      const Component component =
          vertex.is_in_medium()
              ? walk.component_in_medium()
              : walk.component_of(lobe, other_lobe == Lobes::glossy && to.data.specular);
      if (!walk.wants(component)) continue;
      const Spectrum value = reflected * arriving * other.eval_cosine(-direction, other_lobe);
      if (value.is_zero()) continue;
      if (!traced) {
        traced = true;
        visible =
            shadow_ray_transmittance(in.scene, spawn_ray_to(vertex.point(), other.point()),
                                     vertex.medium_toward(direction, walk.medium()),
                                     {walk.wavelengths(), walk.sampler(), is_rough}, walk.rays());
        if (visible.is_zero()) return;
      }
      walk.add(component, value * visible);
    }
  }
}

}  // namespace

void connect_to_light_paths(const CameraPathInputs& inputs, const CameraVertices& vertices,
                            CameraWalk& walk) {
  const std::vector<ConnectibleVertex>& all = inputs.light.connectible;
  if (all.empty() || !any(vertices.here().lobes() & (Lobes::diffuse | Lobes::glossy))) return;
  const auto count = uint32_t(inputs.connections);
  for (uint32_t i = 0; i < count; ++i) {
    // One number alone has too few bits for millions of vertices.
    const Vec2f u = walk.sampler().one_of(Series::connection, count, i).next_2d();
    const double which = (double(u.x) + double(u.y) * 0x1p-24) * double(all.size());
    connect_to(all[std::min(size_t(which), all.size() - 1)], inputs, vertices, walk);
  }
}

}  // namespace kaustik
